// SPDX-License-Identifier: Apache-2.0
#include "client/cli/picture/picture_module.h"

#include <OpenImageIO/imageio.h>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

namespace {

std::vector<OIIO::ImageSpec> Specs(const FlatlightPicture* pictures, int count) {
  std::vector<OIIO::ImageSpec> specs;
  for (int i = 0; i < count; ++i) {
    OIIO::ImageSpec spec(pictures[i].width, pictures[i].height, pictures[i].channels, OIIO::TypeDesc::FLOAT);
    if (pictures[i].channels == 1) spec.channelnames = {"Y"};
    spec.attribute("oiio:ColorSpace", "Linear");
    spec.attribute("compression", "zip");
    if (count > 1) spec.attribute("oiio:subimagename", pictures[i].name);
    specs.push_back(spec);
  }
  return specs;
}

// Empty, or why it failed.
std::string Write(const std::string& path, const FlatlightPicture* pictures, int count) {
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path);
  if (!output) return OIIO::geterror();
  const std::vector<OIIO::ImageSpec> specs = Specs(pictures, count);
  const bool open = count == 1 ? output->open(path, specs[0]) : output->open(path, count, specs.data());
  if (!open) return output->geterror();
  for (int i = 0; i < count; ++i) {
    if (i > 0 && !output->open(path, specs[static_cast<std::size_t>(i)], OIIO::ImageOutput::AppendSubimage))
      return output->geterror();
    if (!output->write_image(OIIO::TypeDesc::FLOAT, pictures[i].pixels)) return output->geterror();
  }
  return output->close() ? "" : output->geterror();
}

}  // namespace

int flatlight_write_pictures(const char* path, const FlatlightPicture* pictures, int count, char* error,
                             std::size_t error_size) {
  try {
    const std::string reason = Write(path, pictures, count);
    std::snprintf(error, error_size, "%s", reason.c_str());
    return reason.empty() ? 0 : 1;
  } catch (const std::exception& failure) {  // OpenEXR reports a full disk so.
    std::snprintf(error, error_size, "%s", failure.what());
    return 1;
  }
}
