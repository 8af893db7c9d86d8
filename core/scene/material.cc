// SPDX-License-Identifier: Apache-2.0
#include "core/scene/material.h"

namespace flatlight {
namespace {

struct Albedo {
  Spectrum operator()(const Lambertian& lambertian) const { return lambertian.reflectance; }
  Spectrum operator()(const Mirror& mirror) const { return mirror.reflectance; }
  Spectrum operator()(const Dielectric&) const { return Spectrum::Grey(1); }
  Spectrum operator()(const Phong& phong) const { return phong.reflectance; }
  Spectrum operator()(const Conductor& conductor) const { return conductor.reflectance; }
};

}  // namespace

Spectrum LargestAlbedo(const Material& material) { return std::visit(Albedo(), material); }

}  // namespace flatlight
