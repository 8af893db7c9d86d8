// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_PROGRESS_PROGRESS_LINE_H_
#define FLATLIGHT_CLIENT_CLI_PROGRESS_PROGRESS_LINE_H_

#include <cstddef>
#include <string>

#include "flatlight/v1/render_service.pb.h"

namespace flatlight {

// One line on how far a job is: "penumbra [########--------]  52 %  error 1.3 %  12.4 M rays/s  3 s left". At most
// `width` columns: the bar goes first, then the end is cut. A width of 0 means a line without bar or bounds, for a log.
std::string ProgressLine(const v1::Job& job, std::size_t width);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_PROGRESS_PROGRESS_LINE_H_
