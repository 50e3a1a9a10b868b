"""Goals, schemes and tables of the records of flow."""
