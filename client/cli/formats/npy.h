// SPDX-License-Identifier: Apache-2.0
// A result as a NumPy file (format 1.0 of numpy.lib.format), for numpy.load.
#ifndef FLATLIGHT_CLIENT_CLI_FORMATS_NPY_H_
#define FLATLIGHT_CLIENT_CLI_FORMATS_NPY_H_

#include <functional>
#include <string>

#include "flatlight/v1/result.pb.h"

namespace flatlight {

// A one-dimensional structured array with an element a point, probe after probe. Fields: probe (int32: number of the
// probe, from 0), index (int32), then those of AllResultColumns() that the result has, as float64; spectral ones have
// shape (3,) in a coloured result. What a probe does not have is NaN.
// Ends early, with what is there, when `stop` says so; it is asked every few thousand points.
std::string ResultToNpy(const v1::RenderResult& result, const std::function<bool()>& stop);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_FORMATS_NPY_H_
