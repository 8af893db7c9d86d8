// SPDX-License-Identifier: Apache-2.0
#include "client/cli/picture/picture_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstdio>
#include <exception>
#include <memory>
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

using Bytes = std::vector<unsigned char>;

// Into memory, because not every format notices when a disk is full. Returns why it failed; empty if it didn't.
std::string Write(const std::string& ending, const FlatlightPicture* pictures, int count, Bytes& bytes) {
  const std::string name = "picture" + ending;  // No file: only the ending counts.
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(name);
  if (!output) return OIIO::geterror();
  OIIO::Filesystem::IOVecOutput memory(bytes);
  if (!output->set_ioproxy(&memory)) return "the format " + ending + " cannot be written to memory";
  const std::vector<OIIO::ImageSpec> specs = Specs(pictures, count);
  const bool open = count == 1 ? output->open(name, specs[0]) : output->open(name, count, specs.data());
  if (!open) return output->geterror();
  for (int i = 0; i < count; ++i) {
    if (i > 0 && !output->open(name, specs[static_cast<std::size_t>(i)], OIIO::ImageOutput::AppendSubimage))
      return output->geterror();
    if (!output->write_image(OIIO::TypeDesc::FLOAT, pictures[i].pixels)) return output->geterror();
  }
  return output->close() ? "" : output->geterror();
}

}  // namespace

int FlatlightWritePictures(const char* ending, const FlatlightPicture* pictures, int count,
                           void (*take)(void* context, const unsigned char* bytes, std::size_t size), void* context,
                           char* error, std::size_t error_size) {
  try {
    Bytes bytes;
    const std::string reason = Write(ending, pictures, count, bytes);
    if (reason.empty()) take(context, bytes.data(), bytes.size());
    std::snprintf(error, error_size, "%s", reason.c_str());
    return reason.empty() ? 0 : 1;
  } catch (const std::exception& failure) {  // OpenEXR throws.
    std::snprintf(error, error_size, "%s", failure.what());
    return 1;
  }
}
