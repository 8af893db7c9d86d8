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

std::shared_ptr<const Scene> RandomRoom(std::uint64_t seed, std::uint32_t times) {
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
  maker.Probe("room", 24 * times).Probe("lamp", 5 * times).Probe("thing0", 5 * times);
  return maker.Build();
}

std::shared_ptr<const Scene> HardRoom(std::uint64_t seed, std::uint32_t times) {
  Random random(~seed);
  const auto chance = [&](double p) { return random.Between(0, 1) < p; };
  const auto power_between = [&](double low, double high) {  // Even in the exponent.
    return std::pow(10, random.Between(low, high));
  };
  const double white = 1 - power_between(-4, -0.3);  // What the brightest reflect.
  const bool alike = chance(0.3);
  const auto look = [&] {
    return Look{.reflectance = {alike ? white : chance(0.1) ? 0 : white * random.Between(chance(0.5) ? 0.9 : 0.1, 1)}};
  };
  SceneMaker maker;
  const double shape = random.Between(0, 1);
  if (shape < 0.35) {
    // One corner's angle is small.
    const double angle = kTurn / 360 * power_between(0.5, 1.8);
    maker.Polyline("room", {{-1, -0.5}, {1, -0.5}, {1, -0.5 + 2 * std::tan(angle)}}, true, look());
  } else if (shape < 0.55) {
    maker.Arc("room", {{0, 0}, 1, random.Between(0, kTurn), kTurn}, look());
  } else if (shape < 0.8) {
    maker.Polyline("room", {{-1, -0.5}, {1, -0.5}, {1, 0.7}, {random.Between(-0.9, 0.9), 1}, {-1, 0.5}}, true, look());
  } else {
    maker.Segment("room", {-1, -0.5}, {1, -0.5}, look());
    maker.Arc("dome", {{0.2, -0.5}, 0.8, 0, random.Between(1, 3)}, look());
    maker.Environment({random.Between(0, 0.5)});
  }
  // A place inside of every room.
  const auto place = [&]() -> Point2 {
    return shape < 0.35 ? Point2{random.Between(0.2, 0.8), -0.5 + 1e-2 * random.Between(1, 4)}
                        : Point2{random.Between(-0.55, 0.55), random.Between(-0.45, 0.4)};
  };
  const double scale = shape < 0.35 ? 0.1 : 1;
  const Point2 at = place();
  Look lamp = look();
  lamp.radiance = {1};
  lamp.two_sided = chance(0.5);
  const double lamp_size = scale * power_between(-2, -0.5);
  maker.Segment("lamp", {at.x + lamp_size, at.y + 0.01 * scale}, {at.x, at.y + 0.02 * scale}, lamp);
  if (chance(0.2)) maker.Light(PointLightDescription{place(), {2}});
  const int things = 1 + static_cast<int>(random.Between(0, 5));
  for (int i = 0; i < things; ++i) {
    const Point2 p = place();
    const double size = scale * power_between(-1.5, -0.3), angle = random.Between(0, kTurn);
    const double gap = power_between(-6, -1.5);
    const Vector2 u{std::cos(angle), std::sin(angle)}, v{-u.y, u.x};
    const std::string name = "thing" + std::to_string(i);
    const double kind = random.Between(0, 1);
    if (kind < 0.25) {
      maker.Segment(name, p, p + size * u, look());
    } else if (kind < 0.5) {
      // Two plates, nearly touching.
      maker.Segment(name, p, p + size * u, look());
      maker.Segment(name + " twin", p + gap * v + random.Between(-0.5, 0.5) * size * u, p + gap * v + size * u, look());
    } else if (kind < 0.65) {
      maker.Arc(name, {p, size / 2, angle, chance(0.5) ? -kTurn : random.Between(0.5, 6)}, look());
    } else if (kind < 0.8) {
      // Two balls, nearly touching.
      maker.Arc(name, {p, size / 2, angle, -kTurn}, look());
      maker.Arc(name + " twin", {p + (0.75 * size + gap) * u, size / 4, angle, -kTurn}, look());
    } else {
      // On the floor of a room that has one, or just above it.
      const double x = p.x, height = chance(0.5) ? -0.5 : -0.5 + gap;
      maker.Segment(name, {x, height}, {x + 0.3 * size * u.x, height + size * (0.1 + std::abs(u.y))}, look());
    }
  }
  maker.Probe("room", 24 * times).Probe("thing0", 8 * times).Probe("thing0", 4 * times, Side::kBack);
  maker.Probe("lamp", 4 * times);
  return maker.Build();
}

}  // namespace flatlight
