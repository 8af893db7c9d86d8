// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_STORED_BYTES_H_
#define FLATLIGHT_SERVER_STORE_STORED_BYTES_H_

#include <cstdint>
#include <string>
#include <unordered_map>

#include "server/store/storage.h"

namespace flatlight {

// How many bytes the requests and results of each owner's jobs take.
using StoredBytes = std::unordered_map<std::string, std::int64_t>;

// As the jobs of a folder say. Those that do not yet (an earlier Flatlight wrote them) are measured, once.
StoredBytes MeasureStoredBytes(Storage& storage);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_STORED_BYTES_H_
