// SPDX-License-Identifier: Apache-2.0
// The state of a rendering as bytes, for the same build on the same kind of machine.
//
// A type with a state says once, for both directions, what it consists of:
//   template <class Self, class Stream> static void State(Self& self, Stream& stream) { stream(self.a_, self.b_); }
#ifndef FLATLIGHT_CORE_RENDER_STATE_STREAM_H_
#define FLATLIGHT_CORE_RENDER_STATE_STREAM_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/scene/spectrum.h"

namespace flatlight {

template <class T>
inline constexpr bool kIsPlain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

// Writes; gives up once there would be more than `most_bytes`.
class StateWriter {
 public:
  explicit StateWriter(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  template <class... Values>
  void operator()(const Values&... values) {
    (Put(values), ...);
  }
  // The elements of a vector that has the same size in whoever reads.
  template <class T>
  void Filled(const std::vector<T>& values) {
    Put(values);
  }
  void Require(bool) {}
  bool ok() const { return ok_; }
  // Empty if it gave up.
  std::string Take() { return ok_ ? std::move(bytes_) : std::string(); }

 private:
  void Append(const void* data, std::size_t size) {
    ok_ = ok_ && size <= most_bytes_ - bytes_.size();
    if (ok_) bytes_.append(static_cast<const char*>(data), size);
  }
  template <class T>
  void Put(const T& value) {
    if constexpr (kIsPlain<T>) {
      Append(&value, sizeof value);
    } else {
      T::State(value, *this);
    }
  }
  template <class T>
  void PutRange(const T* values, std::size_t count) {
    if constexpr (kIsPlain<T>) {
      Append(values, count * sizeof(T));
    } else {
      for (std::size_t i = 0; i < count && ok_; ++i) Put(values[i]);
    }
  }
  template <class T, std::size_t kCount>
  void Put(const std::array<T, kCount>& values) {
    PutRange(values.data(), kCount);
  }
  template <class T>
  void Put(const std::vector<T>& values) {
    Put(std::uint64_t{values.size()});
    PutRange(values.data(), values.size());
  }
  template <class T>
  void Put(const std::optional<T>& value) {
    Put(value.has_value());
    if (value) Put(*value);
  }
  void Put(const std::string& text) {
    Put(std::uint64_t{text.size()});
    Append(text.data(), text.size());
  }
  void Put(const Spectrum& spectrum) { Put(spectrum.value); }

  const std::size_t most_bytes_;
  std::string bytes_;
  bool ok_ = true;
};

// Reads what a StateWriter wrote. At the first thing that does not fit it stops, and nothing after that is read: what
// was read into is of no use then.
class StateReader {
 public:
  explicit StateReader(std::string_view bytes) : bytes_(bytes) {}

  template <class... Values>
  void operator()(Values&... values) {
    (Get(values), ...);
  }
  template <class T>
  void Filled(std::vector<T>& values) {
    std::uint64_t count = 0;
    Get(count);
    Require(count == values.size());
    if (ok_) GetRange(values.data(), values.size());
  }
  void Require(bool condition) { ok_ = ok_ && condition; }
  bool ok() const { return ok_; }
  // Everything was there, and nothing more.
  bool AtEnd() const { return ok_ && bytes_.empty(); }

 private:
  void Take(void* data, std::size_t size) {
    Require(size <= bytes_.size());
    if (!ok_ || size == 0) return;
    std::memcpy(data, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }
  template <class T>
  void Get(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = 0;
      Take(&byte, 1);
      Require(byte <= 1);
      value = byte == 1;
    } else if constexpr (kIsPlain<T>) {
      Take(&value, sizeof value);
    } else {
      T::State(value, *this);
    }
  }
  template <class T>
  void GetRange(T* values, std::size_t count) {
    if constexpr (kIsPlain<T> && !std::is_same_v<T, bool>) {
      Take(values, count * sizeof(T));
    } else {
      for (std::size_t i = 0; i < count && ok_; ++i) Get(values[i]);
    }
  }
  template <class T, std::size_t kCount>
  void Get(std::array<T, kCount>& values) {
    GetRange(values.data(), kCount);
  }
  template <class T>
  void Get(std::vector<T>& values) {
    std::uint64_t count = 0;
    Get(count);
    // Nothing takes less than a byte: no more memory is asked for than there are bytes.
    Require(count <= bytes_.size() / (kIsPlain<T> ? sizeof(T) : 1));
    if (!ok_) return;
    values.resize(count);
    GetRange(values.data(), values.size());
  }
  template <class T>
  void Get(std::optional<T>& value) {
    bool there = false;
    Get(there);
    value.reset();
    if (ok_ && there) Get(value.emplace());
  }
  void Get(std::string& text) {
    std::uint64_t count = 0;
    Get(count);
    Require(count <= bytes_.size());
    if (!ok_) return;
    text = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
  }
  void Get(Spectrum& spectrum) { Get(spectrum.value); }

  std::string_view bytes_;
  bool ok_ = true;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_STATE_STREAM_H_
