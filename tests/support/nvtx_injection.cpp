// Stands for a profiler: NVTX loads it by NVTX_INJECTION64_PATH. Appends `push NAME` and `pop` for every
// range to the file that DROGUE_RANGES names.

#include <nvtx3/nvToolsExt.h>

#include <cstdio>
#include <cstdlib>

namespace {

int depth = 0;

std::FILE* ranges() {
  static std::FILE* const file = std::fopen(std::getenv("DROGUE_RANGES"), "a");
  return file;
}

int NVTX_API push(const char* name) {
  std::fprintf(ranges(), "push %s\n", name), std::fflush(ranges());
  return depth++;
}

int NVTX_API pop() {
  std::fprintf(ranges(), "pop\n"), std::fflush(ranges());
  return --depth;
}

}  // namespace

extern "C" int InitializeInjectionNvtx2(NvtxGetExportTableFunc_t export_table) {
  const auto* callbacks = static_cast<const NvtxExportTableCallbacks*>(export_table(NVTX_ETID_CALLBACKS));
  NvtxFunctionTable table = nullptr;
  unsigned int size = 0;
  if (callbacks == nullptr || callbacks->GetModuleFunctionTable(NVTX_CB_MODULE_CORE, &table, &size) == 0)
    return 0;
  *table[NVTX_CBID_CORE_RangePushA] = reinterpret_cast<NvtxFunctionPointer>(push);
  *table[NVTX_CBID_CORE_RangePop] = reinterpret_cast<NvtxFunctionPointer>(pop);
  return 1;
}
