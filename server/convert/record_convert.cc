// SPDX-License-Identifier: Apache-2.0
#include "server/convert/record_convert.h"

namespace flatlight {

void FillRecord(const RecordField& record, v1::CacheRecord& out) {
  out.add_position(record.position.x), out.add_position(record.position.y);
  out.add_normal(record.normal.x), out.add_normal(record.normal.y);
  out.set_curve(record.curve);
  if (!record.curve.empty()) out.set_side(record.side == Side::kFront ? v1::CacheRecord::FRONT : v1::CacheRecord::BACK);
  out.mutable_irradiance()->Add(record.irradiance.begin(), record.irradiance.end());
  out.mutable_gradient()->Add(record.gradient.begin(), record.gradient.end());
  out.mutable_hessian()->Add(record.hessian.begin(), record.hessian.end());
  out.set_bounce(0);
  out.set_wave(record.wave);
}

}  // namespace flatlight
