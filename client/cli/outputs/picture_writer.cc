// SPDX-License-Identifier: Apache-2.0
#include "client/cli/outputs/picture_writer.h"

#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "client/cli/picture/picture_module.h"

namespace flatlight {
namespace {

std::string ModulePath() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  return (program.parent_path() / "libflatlight_picture.so").string();
}

}  // namespace

std::vector<Picture> PicturesOf(const v1::RenderResult& result) {
  std::vector<Picture> pictures;
  for (const v1::ProbeResult& probe : result.probes()) {
    if (probe.count() == 0) continue;
    Picture picture{probe.name(), static_cast<int>(probe.count()), 1, static_cast<int>(probe.channels()), {}};
    if (probe.has_width())
      picture.width = static_cast<int>(probe.width()), picture.height = static_cast<int>(probe.height());
    const int row = picture.width * picture.channels;
    picture.pixels.reserve(static_cast<std::size_t>(probe.irradiance_size()));
    for (int y = picture.height - 1; y >= 0; --y)
      for (int i = 0; i < row; ++i) picture.pixels.push_back(static_cast<float>(probe.irradiance(y * row + i)));
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

bool HasPictures(const v1::RenderResult& result) {
  return std::any_of(result.probes().begin(), result.probes().end(),
                     [](const v1::ProbeResult& probe) { return probe.has_width(); });
}

Picture Strip(const Picture& line) {
  Picture strip = line;
  strip.height = std::clamp(line.width / 16, 8, 64);
  for (int row = 1; row < strip.height; ++row)
    strip.pixels.insert(strip.pixels.end(), line.pixels.begin(), line.pixels.end());
  return strip;
}

Picture StackedColour(const std::vector<Picture>& pictures) {
  Picture stacked;
  stacked.channels = 3;
  stacked.height = 0;
  for (const Picture& picture : pictures) {
    stacked.width = std::max(stacked.width, picture.width);
    stacked.height += picture.height;
  }
  for (const Picture& picture : pictures)
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < stacked.width; ++x)
        for (int channel = 0; channel < stacked.channels; ++channel) {
          const int source = (y * picture.width + x) * picture.channels + std::min(channel, picture.channels - 1);
          stacked.pixels.push_back(x < picture.width ? picture.pixels[static_cast<std::size_t>(source)] : 0.0F);
        }
  return stacked;
}

absl::Status FindPictureModule() {
  const std::string path = ModulePath();
  if (access(path.c_str(), R_OK) == 0) return absl::OkStatus();
  return absl::FailedPreconditionError("pictures need " + path + ", which is not there");
}

absl::StatusOr<std::string> PictureBytes(const std::string& ending, const std::vector<Picture>& pictures) {
  // Never unloaded: libraries below it register handlers that run at exit.
  void* module = dlopen(ModulePath().c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) return absl::FailedPreconditionError(dlerror());
  const auto write = reinterpret_cast<FlatlightWritePicturesFunction>(dlsym(module, "FlatlightWritePictures"));
  if (write == nullptr) return absl::FailedPreconditionError(dlerror());
  std::vector<FlatlightPicture> rows;
  rows.reserve(pictures.size());
  for (const Picture& picture : pictures)
    rows.push_back({picture.name.c_str(), picture.width, picture.height, picture.channels, picture.pixels.data()});
  std::string bytes;
  const auto take = [](void* context, const unsigned char* data, std::size_t size) {
    static_cast<std::string*>(context)->assign(reinterpret_cast<const char*>(data), size);
  };
  std::array<char, 1024> error{};
  if (write(ending.c_str(), rows.data(), static_cast<int>(rows.size()), take, &bytes, error.data(), error.size()) != 0)
    return absl::InternalError(error.data());
  return bytes;
}

}  // namespace flatlight
