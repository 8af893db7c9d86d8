// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_APP_SPARE_MEMORY_H_
#define FLATLIGHT_SERVER_APP_SPARE_MEMORY_H_

namespace flatlight {

// Memory that jobs have freed stays with the C library: it takes more and more of it for the blocks to come, and gives
// back only what lies at the end of its heaps (mallopt(3), "dynamic mmap threshold"). After a few large jobs that is
// several times what the server uses. To be called every few seconds: where much more is kept than used, the system
// gets it back; of a server that rests, all. Returns whether it did.
bool GiveBackSpareMemory(bool rests);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_APP_SPARE_MEMORY_H_
