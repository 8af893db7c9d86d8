// SPDX-License-Identifier: Apache-2.0
// Results as pictures of 32-bit floats, .exr or .hdr, one row a probe and one pixel a point.
#ifndef FLATLIGHT_CLIENT_CLI_OUTPUTS_PICTURE_WRITER_H_
#define FLATLIGHT_CLIENT_CLI_OUTPUTS_PICTURE_WRITER_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "flatlight/v1/result.pb.h"

namespace flatlight {

struct Picture {
  std::string name;
  int width = 0;
  int height = 1;
  int channels = 1;
  std::vector<float> pixels;
};

// A picture of one row for each probe that has points.
std::vector<Picture> PicturesOf(const v1::RenderResult& result);

// One above the other with 3 channels, as .hdr wants it: shorter rows are filled up with zeros.
Picture StackedColour(const std::vector<Picture>& pictures);

// OK if the module that writes pictures lies beside the program.
absl::Status FindPictureModule();

// A file in memory. `ending` is .exr (a part for each picture) or .hdr (one picture of 3 channels).
absl::StatusOr<std::string> PictureBytes(const std::string& ending, const std::vector<Picture>& pictures);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_OUTPUTS_PICTURE_WRITER_H_
