"""Names of all pictures of a run, without their formats. `--overwrite` and `--restart` of a program remove those of the former run."""

PICTURES = ("fields", "history", "study", "profiles", "spectrum", "canopies", "forces")
SPACE_TIME = "space_time_"  # before the name of a field


def picture_name(name: str) -> str:
    """`name`, which raises ValueError if a program would not remove a picture of that name."""
    if name not in PICTURES and not name.startswith(SPACE_TIME):
        raise ValueError(f"{name} is missing among the names of pictures")
    return name
