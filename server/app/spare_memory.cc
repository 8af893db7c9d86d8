// SPDX-License-Identifier: Apache-2.0
#include "server/app/spare_memory.h"

#include <malloc.h>
#include <unistd.h>

#include <fstream>

namespace flatlight {
namespace {

// What may be kept, as what is given back and wanted again costs a page fault each time; and what is not of the heap:
// stacks, and the libraries' own variables.
constexpr double kSpareBytes = 8e6;
constexpr double kSpareShare = 0.125;  // Of what is used.

// Of this process, without files that it maps. 0 where the system does not tell.
double ResidentOwnBytes() {
  double pages = 0, resident = 0, shared = 0;
  std::ifstream statm("/proc/self/statm");
  if (!(statm >> pages >> resident >> shared)) return 0;
  return (resident - shared) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace

bool GiveBackSpareMemory(bool rests) {
#ifdef __GLIBC__
  const struct mallinfo2 heap = mallinfo2();
  const auto used = static_cast<double>(heap.uordblks + heap.hblkhd);
  if (!rests && ResidentOwnBytes() - used <= kSpareBytes + kSpareShare * used) return false;
  return malloc_trim(0) != 0;
#else
  return false;
#endif
}

}  // namespace flatlight
