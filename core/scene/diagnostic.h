// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_SCENE_DIAGNOSTIC_H_
#define FLATLIGHT_CORE_SCENE_DIAGNOSTIC_H_

#include <cstddef>
#include <string>
#include <vector>

namespace flatlight {

// One mistake in a scene or in settings.
struct Diagnostic {
  std::string path;     // In the words of the scene file, for instance plane.curves[3].emission.radiance[0].
  std::string message;  // The value and what is allowed.
};

// Collects mistakes: keeps the first kMaxKept, counts all.
class Diagnostics {
 public:
  static constexpr std::size_t kMaxKept = 1000;

  void Add(std::string path, std::string message) {
    if (kept_.size() < kMaxKept) kept_.push_back({std::move(path), std::move(message)});
    ++count_;
  }
  bool empty() const { return count_ == 0; }
  std::size_t count() const { return count_; }
  const std::vector<Diagnostic>& kept() const { return kept_; }

 private:
  std::vector<Diagnostic> kept_;
  std::size_t count_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_SCENE_DIAGNOSTIC_H_
