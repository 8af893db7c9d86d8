// SPDX-License-Identifier: Apache-2.0
#include "tests/support/transport/random_room.h"

#include <cmath>
#include <numbers>
#include <string>

#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 1) {}
  double Between(double low, double high) {
    state_ ^= state_ << 13, state_ ^= state_ >> 7, state_ ^= state_ << 17;
    return low + (high - low) * static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

}  // namespace

std::shared_ptr<const Scene> RandomRoom(std::uint64_t seed) {
  Random random(seed);
  const double most = seed % 4 == 0 ? 0.97 : 0.8;
  const auto look = [&] { return Look{.reflectance = {random.Between(0.3, most)}}; };
  SceneMaker maker;
  if (seed % 2 == 0) {
    maker.Polyline("room", {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, true, look());
  } else {
    maker.Segment("room", {-1, -1}, {1, -1}, look());
    maker.Segment("wall", {1, -1}, {1, 0.6}, look());
    maker.Environment({0.3});
  }
  Look lamp = look();
  lamp.radiance = {1};
  maker.Segment("lamp", {random.Between(0.1, 0.6), 0.9}, {random.Between(-0.6, 0), 0.95}, lamp);
  if (seed % 3 == 0) maker.Light(PointLightDescription{{random.Between(-0.8, 0.8), 0.7}, {3}});
  for (int i = 0; i < 3; ++i) {
    const double x = random.Between(-0.8, 0.8), y = random.Between(-0.8, 0.6);
    const double size = random.Between(0.05, 0.3), angle = random.Between(0, kTurn);
    const std::string name = "thing" + std::to_string(i);
    if (random.Between(0, 1) < 0.5) {
      maker.Segment(name, {x, y}, {x + size * std::cos(angle), y + size * std::sin(angle)}, look());
    } else {
      maker.Arc(name, {{x, y}, size / 2, angle, random.Between(0, 1) < 0.5 ? -kTurn : random.Between(1, 5)}, look());
    }
  }
  maker.Probe("room", 24).Probe("lamp", 5).Probe("thing0", 5);
  return maker.Build();
}

}  // namespace flatlight
