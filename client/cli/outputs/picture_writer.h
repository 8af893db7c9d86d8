// SPDX-License-Identifier: Apache-2.0
// Results as pictures: those that are some, and others as one row a probe and one pixel a point.
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

// A picture for each probe that has points, row 0 on top; of points one row.
std::vector<Picture> PicturesOf(const v1::RenderResult& result);

// Whether some probe is a picture.
bool HasPictures(const v1::RenderResult& result);

// A line of pixels high enough to be looked at.
Picture Strip(const Picture& line);

// One above the other with 3 channels, for formats that hold one picture: shorter rows are filled up with zeros.
Picture StackedColour(const std::vector<Picture>& pictures);

// OK if the module that writes pictures lies beside the program.
absl::Status FindPictureModule();

// A file in memory. `ending` is .exr (32-bit floats, a part for each picture), .hdr (one picture of 3 channels) or .png
// (one picture of values in [0, 1], 8 bits).
absl::StatusOr<std::string> PictureBytes(const std::string& ending, const std::vector<Picture>& pictures);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_OUTPUTS_PICTURE_WRITER_H_
