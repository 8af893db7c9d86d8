// SPDX-License-Identifier: Apache-2.0
#include "core/plane/path_tracing/path_tracer.h"

#include <algorithm>
#include <variant>

#include "core/plane/shaft.h"

namespace flatlight {
namespace {

std::vector<ElementId> EmittingPieces(const RayCaster& caster, const PathTracingOptions& options) {
  const Scene& scene = caster.scene();
  const std::vector<ElementId>& unseen = options.unseen_emitters;
  std::vector<ElementId> pieces;
  for (const Curve& curve : scene.curves()) {
    if (!curve.Emits()) continue;
    for (std::uint32_t e = curve.first_element; e < curve.first_element + curve.element_count; ++e) {
      const ElementId id = static_cast<ElementId>(e);
      if (std::find(unseen.begin(), unseen.end(), id) == unseen.end()) pieces.push_back(id);
    }
  }
  return pieces;
}

}  // namespace

PathTracer::Start::Start(const PathTracer& tracer, const Receiver& receiver, const EmitterSight& sight)
    : tracer_(tracer),
      vertex_(VertexAt(tracer.scene_, receiver)),
      view_(tracer.emitters_, vertex_, sight),
      half_angle_(receiver.half_angle) {
  if (half_angle_ > 0) return;
  view_.LookCloser(*tracer.caster_);
  double rays = 0;  // Not counted: how often a point's paths are begun depends on how work is cut.
  tracer.chains_.Find(ChainEffort::kFine, vertex_.at, vertex_.normal, tracer.MostBounces(), rays, chained_);
}

PathTracer::PathTracer(std::shared_ptr<const RayCaster> caster, const PathTracingOptions& options)
    : caster_(std::move(caster)),
      scene_(caster_->scene()),
      options_(options),
      channels_(options.one_channel ? 1 : kMaxChannels),
      emitting_(EmittingPieces(*caster_, options)),
      emitters_(std::shared_ptr<const Scene>(caster_, &caster_->scene()), emitting_),
      sights_(*caster_, emitters_.weighs() ? emitting_ : std::vector<ElementId>()),
      lights_(*caster_),
      chains_(*caster_, {.most_links = MostBounces()}) {
  surfaces_.reserve(scene_.curves().size());
  for (const Curve& curve : scene_.curves()) {
    Surface surface{curve.reflectance, curve.EmittedRadiance(Side::kFront), curve.EmittedRadiance(Side::kBack)};
    if (!std::holds_alternative<Lambertian>(curve.material) && !curve.reflectance.IsBlack()) {
      surface.scattering = static_cast<std::uint32_t>(scatterings_.size());
      scatterings_.emplace_back(curve.material, Side::kFront);
      scatterings_.emplace_back(curve.material, Side::kBack);
    }
    if (const auto* border = std::get_if<Dielectric>(&curve.material)) {
      most_compression_ = std::max({most_compression_, border->ior, 1 / border->ior});
    }
    surfaces_.push_back(surface);
  }
}

bool PathTracer::SkyIsOpen(const Vertex& vertex) const {
  if (scene_.environment().IsBlack()) return true;
  constexpr std::size_t kMostElements = 64;  // In larger scenes something is in the way.
  const std::vector<Element>& elements = scene_.elements();
  if (elements.size() > kMostElements) return false;
  return std::all_of(elements.begin(), elements.end(), [&](const Element& element) {
    const Corners corners = CornersOf(element);
    return std::all_of(corners.point.begin(), corners.point.begin() + corners.count, [&](Point2 corner) {
      return Dot(vertex.normal, corner - vertex.at.position) <= scene_.touch_distance();
    });
  });
}

Spectrum PathTracer::DirectStep(const Receiver& receiver, const EmitterSight& sight) const {
  if (receiver.half_angle > 0) return BrightestEmission();
  const Vertex vertex = VertexAt(scene_, receiver);
  const Spectrum step = options_.nothing_blocks ? Spectrum{} : emitters_.Unblocked(vertex, sight);
  return SkyIsOpen(vertex) ? step : step + 2 * scene_.environment();
}

Spectrum PathTracer::BrightestEmission() const {
  Spectrum brightest = scene_.environment();
  for (const Curve& curve : scene_.curves())
    for (int c = 0; c < kMaxChannels; ++c) brightest[c] = std::max(brightest[c], curve.radiance[c]);
  return brightest;
}

Spectrum PathTracer::BrightestReflection() const {
  Spectrum bright;
  if (options_.max_bounces == 0u || options_.nothing_reflects) return bright;
  Spectrum reflectance;
  for (const Curve& curve : scene_.curves()) {
    for (int c = 0; c < kMaxChannels; ++c) {
      bright[c] = std::max(bright[c], 2 * curve.radiance[c]);
      reflectance[c] = std::max(reflectance[c], curve.reflectance[c]);
    }
  }
  for (int c = 0; c < kMaxChannels; ++c) bright[c] = std::max(bright[c], 2 * scene_.environment()[c]);
  return most_compression_ * (bright * reflectance);
}

Spectrum PathTracer::DirectRounding(const Receiver& receiver, const EmitterSight& sight) const {
  if (receiver.half_angle > 0) return {};  // Radiance is what it is.
  const Vertex vertex = VertexAt(scene_, receiver);
  return emitters_.Rounding(vertex, sight) + lights_.Rounding(vertex);
}

}  // namespace flatlight
