#pragma once

#include <span>
#include <string>
#include <vector>

#include "kernels/fabric/results.hpp"
#include "miniapps/framework/simulation.hpp"
#include "miniapps/parachute/canopy/canopy_state.hpp"
#include "miniapps/parachute/scene/scene.hpp"

// Canopies in history.csv, and all sheets in fields.h5.

namespace drogue::parachute_app {

/// Fluid far upstream of canopies, which rows of history.csv need: its velocity, m/s, and whether it has a
/// speed relative to each canopy. The expressions of a scene are evaluated once.
/// Throws only std::bad_alloc.
struct Airstream {
  explicit Airstream(const FlowScene& scene);

  fabric::Vector velocity;
  fabric::Vector up;  ///< unit vector against gravity; zero without
  std::vector<bool> has_speed;
};

/// Appends the measures of all canopies in the order of `history_columns`. The frame of `state` has its
/// origin at `origin`, m, and moves at `velocity`, m/s. Throws only std::bad_alloc.
void append_measures(const FlowScene& scene, const Airstream& stream, const Sheets& sheets,
                     const SheetState& state, const fabric::Vector& origin, const fabric::Vector& velocity,
                     framework::HistoryRow& row);

/// Number of intersections of sheets and lines that are not cut at a time, s, with sheets and with their
/// images beyond periodic sides. Throws only std::bad_alloc.
[[nodiscard]] double count_intersections(const FlowScene& scene, const Sheets& sheets,
                                         std::span<const fabric::Vector> positions, double time);

/// Dataset of a field of canopies. Throws only std::bad_alloc.
[[nodiscard]] run::DatasetSpec canopy_field_spec(const Sheets& sheets, const std::string& name);

/// Writes the mesh of all canopies. Throws `Failure` (io_error).
void write_canopy_mesh(const Sheets& sheets, run::FieldSink& fields);

/// Values of the field `position`, m, of the vertices of canopies. Does not throw.
void copy_canopy_positions(const Sheets& sheets, std::span<const fabric::Vector> positions,
                           std::span<double> values);

/// Values of the field `von_mises`, N/m, of the triangles of canopies. Does not throw.
void copy_canopy_stress(const Sheets& sheets, std::span<const fabric::Stress> stress,
                        std::span<double> values);

/// Bodies or flags of a scene as one grid of fields.h5.
struct SheetGrid {
  std::string name;                ///< of the groups below /mesh and /steps/N
  std::size_t begin = 0, end = 0;  ///< vertices of the sheets
  bool moves = false;              ///< their positions are written at every output
};

/// The bodies, then the flags, if the scene has them. Throws only std::bad_alloc.
[[nodiscard]] std::vector<SheetGrid> grids_beside_canopies(const FlowScene& scene, const Sheets& sheets);

/// Dataset of the positions of a grid that moves. Throws only std::bad_alloc.
[[nodiscard]] run::DatasetSpec position_spec(const SheetGrid& grid);

/// Writes the mesh of a grid. Throws `Failure` (io_error).
void write_sheet_mesh(const Sheets& sheets, const SheetGrid& grid, run::FieldSink& fields);

/// Values of the positions, m, of the vertices from `begin` on. Does not throw.
void copy_positions(std::size_t begin, std::span<const fabric::Vector> positions, std::span<double> values);

/// Cause of a failed step of cloth. Does not throw.
[[nodiscard]] const char* cloth_failure_text(fabric::FailureReason reason);

/// Part of a canopy that a vertex belongs to; empty for other vertices. Throws only std::bad_alloc.
[[nodiscard]] std::string canopy_vertex_text(const Sheets& sheets, std::size_t vertex);

/// Message of a run that ends at the limit of steps, at a time, s. Throws only std::bad_alloc.
[[nodiscard]] std::string step_limit_text(const FlowScene& scene, double time);

}  // namespace drogue::parachute_app
