// SPDX-License-Identifier: Apache-2.0
#include "client/cli/picture/picture_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

namespace {

std::vector<OIIO::ImageSpec> Specs(const std::string& ending, const FlatlightPicture* pictures, int count) {
  const bool screen = ending == ".png";
  std::vector<OIIO::ImageSpec> specs;
  int full_width = 0;
  for (int i = 0; i < count; ++i) full_width = std::max(full_width, pictures[i].width);
  for (int i = 0; i < count; ++i) {
    OIIO::ImageSpec spec(pictures[i].width, pictures[i].height, pictures[i].channels,
                         screen ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT);
    spec.full_width = full_width;  // OpenEXR wants one display window for all parts; data windows may differ.
    if (pictures[i].channels == 1) spec.channelnames = {"Y"};
    spec.attribute("oiio:ColorSpace", screen ? "sRGB" : "Linear");
    if (!screen) spec.attribute("compression", "zip");
    if (count > 1) spec.attribute("oiio:subimagename", pictures[i].name);
    specs.push_back(spec);
  }
  return specs;
}

using Bytes = std::vector<unsigned char>;

class MemoryFile {
 public:
  MemoryFile() : fd_(memfd_create("flatlight-picture", MFD_CLOEXEC)) {}
  ~MemoryFile() {
    if (fd_ >= 0) close(fd_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string name() const { return "/proc/self/fd/" + std::to_string(fd_); }

  bool Read(Bytes& bytes) const {
    struct stat info {};
    if (fstat(fd_, &info) != 0 || info.st_size == 0) return false;
    bytes.resize(static_cast<std::size_t>(info.st_size));
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t n = pread(fd_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
      if (n <= 0) return false;
      done += static_cast<std::size_t>(n);
    }
    return true;
  }

 private:
  int fd_;
};

// Into memory, because not every format notices when a disk is full. Returns why it failed; empty if it didn't.
std::string WriteOne(const std::string& ending, const FlatlightPicture& picture, Bytes& bytes) {
  const std::string name = "picture" + ending;  // No file: only the ending counts.
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(name);
  if (!output) return OIIO::geterror();
  OIIO::Filesystem::IOVecOutput memory(bytes);
  if (!output->set_ioproxy(&memory)) return "the format " + ending + " cannot be written to memory";
  const std::vector<OIIO::ImageSpec> specs = Specs(ending, &picture, 1);
  if (!output->open(name, specs[0])) return output->geterror();
  if (!output->write_image(OIIO::TypeDesc::FLOAT, picture.pixels)) return output->geterror();
  return output->close() ? "" : output->geterror();
}

// Parts are written to a name only (OpenImageIO 2.4 ignores the memory that it is given): to that of a file in memory.
std::string WriteParts(const std::string& ending, const FlatlightPicture* pictures, int count, Bytes& bytes) {
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("picture" + ending);
  if (!output) return OIIO::geterror();
  const MemoryFile file;
  const std::vector<OIIO::ImageSpec> specs = Specs(ending, pictures, count);
  if (!output->open(file.name(), count, specs.data())) return output->geterror();
  for (int i = 0; i < count; ++i) {
    if (i > 0 && !output->open(file.name(), specs[static_cast<std::size_t>(i)], OIIO::ImageOutput::AppendSubimage))
      return output->geterror();
    if (!output->write_image(OIIO::TypeDesc::FLOAT, pictures[i].pixels)) return output->geterror();
  }
  if (!output->close()) return output->geterror();
  return file.Read(bytes) ? "" : "the picture in memory cannot be read";
}

}  // namespace

int FlatlightWritePictures(const char* ending, const FlatlightPicture* pictures, int count,
                           void (*take)(void* context, const unsigned char* bytes, std::size_t size), void* context,
                           char* error, std::size_t error_size) {
  try {
    Bytes bytes;
    const std::string reason =
        count == 1 ? WriteOne(ending, pictures[0], bytes) : WriteParts(ending, pictures, count, bytes);
    if (reason.empty()) take(context, bytes.data(), bytes.size());
    std::snprintf(error, error_size, "%s", reason.c_str());
    return reason.empty() ? 0 : 1;
  } catch (const std::exception& failure) {  // OpenEXR throws.
    std::snprintf(error, error_size, "%s", failure.what());
    return 1;
  }
}
