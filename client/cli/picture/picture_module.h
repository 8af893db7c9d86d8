// SPDX-License-Identifier: Apache-2.0
// The one interface to the module that links OpenImageIO, libflatlight_picture.so. It lies beside the program and is
// loaded when a picture is written: its some 260 libraries would cost every start 300 ms.
#ifndef FLATLIGHT_CLIENT_CLI_PICTURE_PICTURE_MODULE_H_
#define FLATLIGHT_CLIENT_CLI_PICTURE_PICTURE_MODULE_H_

#include <cstddef>

extern "C" {

// Rows from the top, pixels from the left, channels together.
struct FlatlightPicture {
  const char* name;
  int width;
  int height;
  int channels;  // 1 or 3; .hdr knows 3 only. .png takes values in [0, 1], encoded already.
  const float* pixels;
};

// Makes a file in the format that `ending` (".exr") names, with one part for each picture (`count` is 1 if the format
// has no parts), in memory: its bytes go to `take`, once. Returns 0, or another number with a reason in `error`.
int FlatlightWritePictures(const char* ending, const FlatlightPicture* pictures, int count,
                           void (*take)(void* context, const unsigned char* bytes, std::size_t size), void* context,
                           char* error, std::size_t error_size);
using FlatlightWritePicturesFunction = decltype(&FlatlightWritePictures);
}

#endif  // FLATLIGHT_CLIENT_CLI_PICTURE_PICTURE_MODULE_H_
