// SPDX-License-Identifier: Apache-2.0
#include "core/plane/materials/scattering.h"

#include <cmath>
#include <variant>

#include "core/plane/materials/fresnel.h"

namespace flatlight {
namespace {

std::optional<ScatterSample> SampleLambertian(const Lambertian& lambertian, double u) {
  ScatterSample sample;
  sample.in.sine = 2 * u - 1;
  sample.in.cosine = std::sqrt((1 - sample.in.sine) * (1 + sample.in.sine));
  sample.density = 0.5 * sample.in.cosine;
  sample.weight = lambertian.reflectance;
  if (!(sample.density > 0)) return std::nullopt;
  return sample;
}

ScatterSample SampleBorder(LocalDirection out, double ratio, double u) {
  const FresnelSplit split = SplitAtBorder(out, ratio);
  ScatterSample sample;
  sample.weight = Spectrum::Grey(1);
  if (u < split.reflected) {
    sample.in = Mirrored(out);
  } else {
    sample.in = split.transmitted;
    sample.compression = 1 / ratio;
  }
  return sample;
}

}  // namespace

Scattering::Kind Scattering::KindOf(const Material& material, Side side) {
  if (const auto* lambertian = std::get_if<Lambertian>(&material)) return *lambertian;
  if (const auto* mirror = std::get_if<Mirror>(&material)) return *mirror;
  if (const auto* dielectric = std::get_if<Dielectric>(&material)) {
    return Border{side == Side::kFront ? dielectric->ior : 1 / dielectric->ior};
  }
  if (const auto* phong = std::get_if<Phong>(&material)) return Glossy{CosineLobe(phong->exponent), phong->reflectance};
  const auto& conductor = std::get<Conductor>(material);
  return Glossy{Microfacets(conductor.alpha), conductor.reflectance};
}

Scattering::Scattering(const Material& material, Side side) : kind_(KindOf(material, side)) {}

Spectrum Scattering::Value(LocalDirection out, LocalDirection in) const {
  if (!(out.cosine > 0) || !(in.cosine > 0)) return {};
  if (const auto* lambertian = std::get_if<Lambertian>(&kind_)) return 0.5 * lambertian->reflectance;
  const auto* glossy = std::get_if<Glossy>(&kind_);
  if (glossy == nullptr) return {};
  return std::visit([&](const auto& lobe) { return lobe.Value(out, in); }, glossy->lobe) * glossy->reflectance;
}

double Scattering::Density(LocalDirection out, LocalDirection in) const {
  if (!(out.cosine > 0) || !(in.cosine > 0)) return 0;
  if (std::holds_alternative<Lambertian>(kind_)) return 0.5 * in.cosine;
  const auto* glossy = std::get_if<Glossy>(&kind_);
  if (glossy == nullptr) return 0;
  return std::visit([&](const auto& lobe) { return lobe.Density(out, in); }, glossy->lobe);
}

std::optional<ScatterSample> Scattering::Sample(LocalDirection out, double u, double v) const {
  if (const auto* lambertian = std::get_if<Lambertian>(&kind_)) return SampleLambertian(*lambertian, u);
  if (const auto* mirror = std::get_if<Mirror>(&kind_)) {
    return ScatterSample{.in = Mirrored(out), .weight = mirror->reflectance};
  }
  if (const auto* border = std::get_if<Border>(&kind_)) return SampleBorder(out, border->ratio, u);
  const auto& glossy = std::get<Glossy>(kind_);
  const auto in = std::visit([&](const auto& lobe) { return lobe.Sample(out, u, v); }, glossy.lobe);
  if (!in.has_value()) return std::nullopt;
  ScatterSample sample;
  sample.in = *in;
  sample.density = Density(out, *in);
  if (!(sample.density > 0)) return std::nullopt;
  sample.weight = in->cosine / sample.density * Value(out, *in);
  return sample;
}

}  // namespace flatlight
