// Functions of NVML that perf/clocks calls. The GPU at 0000:19:00.0 falls from 1980 to 1500 MHz at its second
// reading, because of its power cap; that at 0000:1a:00.0 cannot be read.

extern "C" {

int nvmlInit_v2() { return 0; }

int nvmlDeviceGetHandleByPciBusId_v2(const char* address, void** device) {
  static int known, unreadable;
  const char kind = address[6];
  *device = kind == '9' ? &known : &unreadable;
  return kind == '9' || kind == 'a' ? 0 : 6;
}

int nvmlDeviceGetClockInfo(void* device, int kind, unsigned* mhz) {
  static void* first = device;
  static int readings = 0;
  if (device != first) return 15;
  if (kind == 1) ++readings;
  *mhz = kind == 2 ? 2619 : readings == 1 ? 1980 : 1500;
  return 0;
}

int nvmlDeviceGetCurrentClocksThrottleReasons(void*, unsigned long long* reasons) {
  static int readings = 0;
  // Bit 0: idle, which is no throttling.
  *reasons = ++readings == 1 ? 0x1 : 0x4;
  return 0;
}
}
