#include "kernels/fabric/stepping/patches.hpp"

#include <algorithm>
#include <map>

#include "kernels/mesh/partition.hpp"

namespace drogue::fabric {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

int whole_slices(int vertices) { return (vertices + slice - 1) / slice * slice; }

/// Entries of vertex i without the neutral slots at the end.
template <int values>
std::vector<EllEntry<values>> entries_of(const SlicedEll<values>& slots, int i) {
  std::vector<EllEntry<values>> entries;
  const std::size_t lane = index(i % slice);
  for (int k = slots.first[index(i / slice)]; k < slots.first[index(i / slice + 1)]; ++k) {
    const std::size_t slot = index(k) * slice + lane;
    EllEntry<values> entry{slots.neighbour[slot], {}};
    for (std::size_t a = 0; a < values; ++a) entry.value[a] = slots.value[a][slot];
    entries.push_back(entry);
  }
  while (!entries.empty() && entries.back().neighbour == i) entries.pop_back();
  return entries;
}

template <int values>
void append(SlicedEll<values>& to, const SlicedEll<values>& more) {
  if (to.first.empty()) to.first.push_back(0);
  const int begin = to.first.back();
  for (std::size_t s = 1; s < more.first.size(); ++s) to.first.push_back(begin + more.first[s]);
  to.neighbour.insert(to.neighbour.end(), more.neighbour.begin(), more.neighbour.end());
  for (std::size_t a = 0; a < values; ++a)
    to.value[a].insert(to.value[a].end(), more.value[a].begin(), more.value[a].end());
}

/// Slots of a patch; `local` maps vertices of the mesh to the numbers of the team.
template <int values, class Local>
SlicedEll<values> slots_of_patch(const SlicedEll<values>& slots, const std::vector<int>& vertices, int team,
                                 const Local& local) {
  std::vector<std::vector<EllEntry<values>>> of_rank(index(team));
  for (std::size_t rank = 0; rank < vertices.size(); ++rank) {
    of_rank[rank] = entries_of(slots, vertices[rank]);
    for (EllEntry<values>& entry : of_rank[rank]) entry.neighbour = local(entry.neighbour);
  }
  return sliced(of_rank);
}

/// Appends the rows of pairs of the last patch.
void append_rows(Patches& patches) {
  const int slices = patches.team / slice;
  const auto begin = patches.triangles.first.size() - 1 - index(slices);
  for (int s = 0; s < slices; ++s) {
    const int end = patches.triangles.first[begin + index(s) + 1];
    for (int k = patches.triangles.first[begin + index(s)] + 1; k < end; k += 2)
      patches.row.push_back({s * slice, k * slice, std::min(2, end - k)});
  }
  const int rows = static_cast<int>(patches.row.size());
  patches.max_rows = std::max(patches.max_rows, rows - patches.first_row.back());
  patches.first_row.push_back(rows);
}

}  // namespace

Patches make_patches(const std::vector<Vector>& rest, const RingAdjacency& triangles,
                     const SpringAdjacency& springs, int count) {
  const std::vector<std::vector<int>> own = mesh::partition_by_recursive_bisection(rest, count);
  std::vector<int> patch_of(rest.size());
  for (std::size_t p = 0; p < own.size(); ++p)
    for (const int i : own[p]) patch_of[index(i)] = static_cast<int>(p);

  Patches patches;
  patches.first_halo.push_back(0);
  patches.first_row.push_back(0);
  std::vector<std::vector<int>> halo(own.size());
  std::vector<int> message(rest.size(), -1);
  std::size_t most_own = 0;
  for (std::size_t p = 0; p < own.size(); ++p) {
    most_own = std::max(most_own, own[p].size());
    const auto add = [&](int j) {
      if (patch_of[index(j)] != static_cast<int>(p)) halo[p].push_back(j), message[index(j)] = 0;
    };
    for (const int i : own[p]) {
      for (const auto& entry : entries_of(triangles, i)) add(entry.neighbour);
      for (const auto& entry : entries_of(springs, i)) add(entry.neighbour);
    }
    std::ranges::sort(halo[p]);
    const auto repeated = std::ranges::unique(halo[p]);
    halo[p].erase(repeated.begin(), repeated.end());
    patches.first_halo.push_back(patches.first_halo.back() + static_cast<int>(halo[p].size()));
    patches.max_halo = std::max(patches.max_halo, static_cast<int>(halo[p].size()));
  }
  // Messages of a patch are adjacent, so that its threads write and read whole cache lines.
  for (const auto& vertices : own)
    for (const int i : vertices)
      if (message[index(i)] == 0) message[index(i)] = patches.messages++;

  patches.team = whole_slices(static_cast<int>(most_own));
  for (std::size_t p = 0; p < own.size(); ++p) {
    std::map<int, int> number;
    for (std::size_t rank = 0; rank < index(patches.team); ++rank) {
      const bool there = rank < own[p].size();
      patches.vertex.push_back(there ? own[p][rank] : -1);
      patches.message.push_back(there ? message[index(own[p][rank])] : -1);
      if (there) number[own[p][rank]] = static_cast<int>(rank);
    }
    for (const int j : halo[p]) {
      number[j] = patches.team + static_cast<int>(patches.halo_vertex.size()) - patches.first_halo[p];
      patches.halo_vertex.push_back(j);
      patches.halo_message.push_back(message[index(j)]);
    }
    const auto local = [&](int i) { return number.at(i); };
    append(patches.triangles, slots_of_patch(triangles, own[p], patches.team, local));
    append(patches.springs, slots_of_patch(springs, own[p], patches.team, local));
    append_rows(patches);
  }
  return patches;
}

int team_threads(const Patches& patches, int rows, int most) {
  return std::max(patches.team, std::min(whole_slices(std::max(patches.max_halo, rows * slice)), most));
}

}  // namespace drogue::fabric
