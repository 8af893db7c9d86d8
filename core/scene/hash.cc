// SPDX-License-Identifier: Apache-2.0
#include "core/scene/hash.h"

#include <openssl/evp.h>

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <string_view>
#include <unordered_map>

namespace flatlight {
namespace {

class Hasher {
 public:
  Hasher() : context_(EVP_MD_CTX_new()) { EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr); }

  void Add(std::uint64_t value) {
    std::array<unsigned char, 8> bytes;  // Little-endian on every machine.
    for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<unsigned char>(value >> (8 * i));
    EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size());
  }
  void Add(double value) { Add(std::bit_cast<std::uint64_t>(value + 0.0)); }  // -0 counts as 0.
  void Add(Point2 p) { Add(p.x), Add(p.y); }
  void Add(Vector2 v) { Add(v.x), Add(v.y); }
  void Add(const SpectrumValues& values) {
    Add(std::uint64_t{values.size()});
    for (const double value : values) Add(value);
  }
  std::string Hex() {
    std::array<unsigned char, 32> digest;
    EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr);
    std::string text;
    for (const unsigned char byte : digest) {
      constexpr char kDigits[] = "0123456789abcdef";
      text += kDigits[byte >> 4];
      text += kDigits[byte & 15];
    }
    return text;
  }

 private:
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };
  std::unique_ptr<EVP_MD_CTX, Free> context_;
};

void AddShape(const CurveDescription& curve, Hasher& hasher) {
  hasher.Add(std::uint64_t{curve.shape.index()});
  if (const auto* segment = std::get_if<SegmentDescription>(&curve.shape)) {
    hasher.Add(segment->a), hasher.Add(segment->b);
  } else if (const auto* polyline = std::get_if<PolylineDescription>(&curve.shape)) {
    hasher.Add(std::uint64_t{polyline->points.size()});
    for (const Point2& point : polyline->points) hasher.Add(point);
    hasher.Add(std::uint64_t{polyline->closed});
  } else if (const auto* arc = std::get_if<ArcDescription>(&curve.shape)) {
    hasher.Add(arc->center), hasher.Add(arc->radius), hasher.Add(arc->start_angle), hasher.Add(arc->sweep_angle);
  } else if (const auto* bezier = std::get_if<BezierDescription>(&curve.shape)) {
    hasher.Add(bezier->p0), hasher.Add(bezier->p1), hasher.Add(bezier->p2), hasher.Add(bezier->p3);
  }
}

void AddMaterial(const MaterialDescription& material, Hasher& hasher) {
  const auto& kind = material.kind;
  hasher.Add(std::uint64_t{kind.index()});
  if (const auto* lambertian = std::get_if<LambertianDescription>(&kind)) {
    hasher.Add(lambertian->reflectance);
  } else if (const auto* mirror = std::get_if<MirrorDescription>(&kind)) {
    hasher.Add(mirror->reflectance);
  } else if (const auto* dielectric = std::get_if<DielectricDescription>(&kind)) {
    hasher.Add(dielectric->ior);
  } else if (const auto* phong = std::get_if<PhongDescription>(&kind)) {
    hasher.Add(phong->reflectance), hasher.Add(phong->exponent);
  } else if (const auto* conductor = std::get_if<ConductorDescription>(&kind)) {
    hasher.Add(conductor->reflectance), hasher.Add(conductor->roughness);
  }
}

void AddLight(const LightDescription& light, Hasher& hasher) {
  hasher.Add(std::uint64_t{light.kind.index()});
  if (const auto* point = std::get_if<PointLightDescription>(&light.kind)) {
    hasher.Add(point->position), hasher.Add(point->power);
  } else if (const auto* spot = std::get_if<SpotLightDescription>(&light.kind)) {
    hasher.Add(spot->position), hasher.Add(spot->direction), hasher.Add(spot->power);
    hasher.Add(spot->cone_angle), hasher.Add(spot->edge_angle);
  } else if (const auto* directional = std::get_if<DirectionalLightDescription>(&light.kind)) {
    hasher.Add(directional->direction), hasher.Add(directional->irradiance);
  }
}

// What follows is no curve: no shape has this number.
constexpr std::uint64_t kNoMoreCurves = 1000;
// A picture or a camera follows, not another probe: those begin with 0 or 1.
constexpr std::uint64_t kPicture = 1000;
constexpr std::uint64_t kCamera = 1001;

}  // namespace

std::string HashWorld(const SceneDescription& description) {
  std::unordered_map<std::string, const MaterialDescription*> materials;
  for (const MaterialDescription& material : description.materials) materials.emplace(material.name, &material);
  Hasher hasher;
  for (const CurveDescription& curve : description.curves) {
    AddShape(curve, hasher);
    AddMaterial(*materials.at(curve.material), hasher);
    hasher.Add(std::uint64_t{curve.emission.has_value()});
    if (curve.emission) {
      hasher.Add(curve.emission->radiance);
      hasher.Add(std::uint64_t{curve.emission->two_sided});
    }
  }
  if (!description.lights.empty() || description.environment) {
    hasher.Add(kNoMoreCurves);
    for (const LightDescription& light : description.lights) AddLight(light, hasher);
    if (description.environment) hasher.Add(kNoMoreCurves), hasher.Add(description.environment->radiance);
  }
  return hasher.Hex();
}

std::string HashProbes(const SceneDescription& description) {
  std::unordered_map<std::string_view, std::uint64_t> curves;  // Those with a probe.
  for (const ProbeDescription& probe : description.probes)
    if (probe.curve) curves.emplace(*probe.curve, 0);
  for (std::size_t i = 0; i < description.curves.size(); ++i)
    if (const auto probed = curves.find(description.curves[i].name); probed != curves.end()) probed->second = i;
  Hasher hasher;
  for (const ProbeDescription& probe : description.probes) {
    hasher.Add(std::uint64_t{probe.curve.has_value()});
    if (probe.curve) {
      hasher.Add(curves.at(*probe.curve));
      hasher.Add(std::uint64_t{*probe.count});
      hasher.Add(probe.from.value_or(0));
      hasher.Add(probe.to.value_or(1));
      hasher.Add(std::uint64_t{probe.side.value_or(Side::kFront) == Side::kBack});
    }
    hasher.Add(std::uint64_t{probe.points.size()});
    for (const ProbePointDescription& point : probe.points) hasher.Add(point.position), hasher.Add(point.normal);
    if (probe.fluence) {
      hasher.Add(kPicture);
      hasher.Add(std::uint64_t{probe.fluence->min.has_value()});
      if (probe.fluence->min) hasher.Add(*probe.fluence->min), hasher.Add(*probe.fluence->max);
      hasher.Add(std::uint64_t{*probe.fluence->width}), hasher.Add(std::uint64_t{*probe.fluence->height});
    }
    if (probe.camera) {
      const CameraDescription& camera = *probe.camera;
      hasher.Add(kCamera);
      hasher.Add(camera.position), hasher.Add(camera.target);
      hasher.Add(camera.up.value_or(Vector2{}));
      hasher.Add(camera.field_of_view), hasher.Add(std::uint64_t{*camera.width});
    }
  }
  return hasher.Hex();
}

}  // namespace flatlight
