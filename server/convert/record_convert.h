// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_CONVERT_RECORD_CONVERT_H_
#define FLATLIGHT_SERVER_CONVERT_RECORD_CONVERT_H_

#include "core/render/field.h"
#include "flatlight/v1/result.pb.h"

namespace flatlight {

// All but the radius, which alone may change while records are made.
void FillRecord(const RecordField& record, v1::CacheRecord& out);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_CONVERT_RECORD_CONVERT_H_
