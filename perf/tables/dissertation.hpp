#pragma once

/// Numbers of the tables of [Shi], as printed, for comparison.
namespace drogue::perf::dissertation {

/// Table 4.1: the machine, whose clock of the GPU is printed as "1.15 Hz".
struct Machine {
  const char *cpu, *caches, *gpu, *gpu_memory, *registers, *os, *compiler, *cuda;
};
inline constexpr Machine table_4_1 = {
    "two Xeon E5-2687W, 8 cores each, 3.1 GHz, 64 GB",
    "L1 16 x 32 KB, L2 16 x 256 KB, L3 2 x 20 MB",
    "two Quadro 6000, 14 multiprocessors, 448 cores, 1.15 GHz",
    "6 GB global, 64 KB constant, 48 KB shared",
    "32768 registers per multiprocessor",
    "Fedora 18, kernel 3.9.2-200",
    "GCC 4.7.2",
    "Toolkit 5.0",
};

/// Table 4.2: resident blocks of the flux kernel on a multiprocessor of compute capability 2.0, by limit.
struct OccupancyRow {
  int block, shared_bytes, by_registers, by_shared_memory, by_limit, blocks, threads, device_threads;
  double percent;
};
inline constexpr OccupancyRow table_4_2[] = {
    {32, 3344, 16, 14, 8, 8, 256, 3584, 16.7}, {64, 6160, 8, 7, 8, 7, 448, 6272, 29.2},
    {128, 11792, 4, 4, 8, 4, 512, 7168, 33.3}, {192, 17424, 2, 2, 8, 2, 384, 5376, 25.0},
    {256, 23056, 2, 2, 8, 2, 512, 7168, 33.3}, {384, 34320, 1, 1, 8, 1, 384, 5376, 25.0},
    {512, 45584, 1, 1, 8, 1, 512, 7168, 33.3}, {544, 48400, 0, 1, 8, 0, 0, 0, 0.0}};
inline constexpr int flux_registers = 63;  ///< per thread

/// Shared memory of a block, bytes: its cells and two halos of three cells, 11 doubles per cell. Does not
/// throw.
constexpr int flux_shared_bytes(int block) { return (block + 2 * 3) * 11 * 8; }

/// Table 5.5: us per step on the CPU, 0 where no time is printed, and on a Quadro 6000 with blocks of 128
/// threads.
struct TransferRow {
  int cells;
  double cpu, h2d, compute, d2h, total;
};
inline constexpr TransferRow table_5_5[] = {
    {1024, 0, 336, 118, 272, 726},      {2048, 6896, 349, 146, 273, 768},  {3072, 10053, 365, 152, 283, 800},
    {4096, 13912, 340, 183, 365, 888},  {5120, 16774, 411, 215, 321, 947}, {6144, 20126, 397, 249, 308, 954},
    {7168, 23463, 525, 271, 396, 1192}, {8192, 25376, 509, 363, 365, 1237}};

/// Figure 4.4: block sizes for which time is plotted against the meshes of table 5.5.
inline constexpr int figure_4_4_blocks[] = {32, 64, 128, 192, 256, 384, 512};

/// Table 5.6: us per step on the CPU and on the GPU. The number of substeps between two copies is not
/// printed.
struct FabricTransferRow {
  int vertices;
  double cpu, h2d, compute, d2h, total;
};
inline constexpr FabricTransferRow table_5_6[] = {
    {2641, 223565, 171, 41328, 644, 42143},  {4279, 294037, 340, 42200, 1239, 43734},
    {6466, 376137, 376, 51180, 530, 52086},  {9064, 481941, 786, 70444, 2241, 73471},
    {12361, 554545, 687, 85744, 727, 87158}, {15567, 601600, 1503, 96310, 1066, 98879}};

/// Numbers of substeps that are measured for comparison with table 5.6.
inline constexpr int table_5_6_substeps[] = {1, 10, 34, 100};

/// Tables 5.7 and 5.8: us per batch of American puts on the CPU and on the GPU; 0 where no time is printed.
struct OptionsRow {
  int options, mesh;
  double cpu, h2d, compute, d2h, total;
};
inline constexpr OptionsRow table_5_7[] = {
    {1, 128, 0, 752740, 540774, 55, 1293569},          {1, 256, 2825369, 757925, 1034025, 59, 1792009},
    {1, 512, 8088534, 757555, 2124162, 115, 2881832},  {1, 1024, 22214927, 780483, 3867521, 79, 4648083},
    {1, 2048, 55254249, 810256, 6475537, 87, 7285880}, {1, 4096, 134558431, 755945, 11294322, 256, 12050523}};
inline constexpr OptionsRow table_5_8[] = {{32, 128, 35361760, 2902, 3892648, 96, 3895646},
                                           {64, 128, 70723520, 3484, 3900757, 324, 3904565},
                                           {128, 128, 141447040, 2752, 3954747, 195, 3957694},
                                           {256, 128, 282894080, 3199, 3955152, 382, 3958733},
                                           {512, 128, 565788160, 3200, 4097343, 1429, 4101972},
                                           {1024, 128, 1131576320, 3232, 4366600, 1064, 4370896},
                                           {2048, 128, 2263152640, 3257, 4767045, 1945, 4772247},
                                           {4096, 128, 4526305280, 3328, 9540157, 3352, 9546837}};

}  // namespace drogue::perf::dissertation
