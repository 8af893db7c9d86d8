// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_PATH_TRACING_EMITTER_SAMPLER_H_
#define FLATLIGHT_CORE_PLANE_PATH_TRACING_EMITTER_SAMPLER_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/plane/path_tracing/emitter_range.h"
#include "core/plane/path_tracing/emitter_sights.h"
#include "core/plane/path_tracing/emitter_tree.h"
#include "core/plane/path_tracing/vertex.h"
#include "core/plane/ray_caster.h"
#include "core/scene/scene.h"

namespace flatlight {

// A point of an emitter, as seen from a vertex.
struct EmitterSample {
  SurfacePoint point;
  Spectrum radiance;
  double cosine = 0;   // At the vertex; positive.
  double density = 0;  // Per radian at the vertex.
};

// Chooses points on emitters for a vertex. With up to kMostWeighed emitting pieces they are weighed at every vertex by
// the irradiance they would give if nothing blocked; with more a tree leads to a few of them, which are. Straight and
// circular emitters are sampled uniformly in the sine of the direction, other arcs uniformly in arc length. All
// densities are per angle: pdf_theta = pdf_length * distance / cosine at the emitter (THEORY 18 B11).
class EmitterSampler {
 public:
  static constexpr std::size_t kMostWeighed = 16;
  static_assert(kMostWeighed <= EmitterSight::kMost);

  // `pieces`: which to sample, in the order of elements; all others never light a vertex that will be asked about.
  EmitterSampler(std::shared_ptr<const Scene> scene, const std::vector<ElementId>& pieces);

  // Irradiance from all pieces but those whose way is known to be clear or hidden, if nothing blocked them, as one
  // sample may give it; a guess for arcs seen partly from inside, and for thousands of pieces.
  Spectrum Unblocked(const Vertex& vertex, const EmitterSight& sight) const;
  // The rounding of directions in irradiance from all pieces that are not hidden.
  Spectrum Rounding(const Vertex& vertex, const EmitterSight& sight) const;

  bool empty() const { return pieces_.empty(); }
  // Whether emitters are weighed at every vertex.
  bool weighs() const { return pieces_.size() <= kMostWeighed; }

  // The emitters as seen from one vertex. Refers to the first two arguments. Where emitters are weighed, the sight
  // counts: those that it knows to be hidden are left out, and the light of those whose way is clear is certain() and
  // not sampled.
  class View {
   public:
    View(const EmitterSampler& sampler, const Vertex& vertex, const EmitterSight& sight);
    View(const View&) = delete;
    View& operator=(const View&) = delete;
    // For a vertex from which many samples will be asked: takes longer, and then chooses better among many. Casts a ray
    // to the middle of each piece that it sees one by one (up to EmitterTree::kMostClusters leaves of pieces); where
    // that is hidden, the piece gets a part of its weight.
    void LookCloser(const RayCaster& caster);

    // No emitter can light the vertex, certain light aside.
    bool empty() const { return total_ == 0; }
    // Irradiance from the emitters whose way is clear: radiance times the difference of sines.
    const Spectrum& certain() const { return certain_; }
    bool any_certain() const { return certain_pieces_ != 0; }
    // Calls visit(point, light) for a point of each of these emitters, chosen by the same number for all, and its part
    // of certain().
    template <typename Visit>
    void VisitCertain(double u, Visit visit) const {
      for (std::uint32_t i = 0; (certain_pieces_ >> i) != 0; ++i) {
        if (((certain_pieces_ >> i) & 1) != 0)
          visit(PlaceOn(i, u), seen_[i].range.width * sampler_.pieces_[i].radiance);
      }
    }
    // Emitter sampling alone has no more variance than cosine sampling alone: rays that hit an emitter by chance need
    // not be counted. The variances are T * E - E^2 and 2 * (integral of L^2 V ds) - E^2, where T is the irradiance
    // that emitters would give unblocked; so it is enough that T <= 2 * (smallest radiance in view). After a closer
    // look it is likely, not certain: what those rays met stands for the pieces.
    bool sufficient() const { return sufficient_; }
    // A point chosen by one number in [0, 1). Absent if it does not light the vertex.
    std::optional<EmitterSample> Sample(double u) const;
    // The density per radian with which Sample gives the point `hit`, in `direction` of this cosine; infinite if its
    // light is certain.
    double Density(const Hit& hit, Vector2 direction, double cosine) const;

   private:
    struct Seen {
      EmitterRange range;
      double weight = 0;  // 0 if the range is empty.
    };
    // A piece, or a cluster of the tree.
    struct Group {
      double weight_end = 0;    // Sum of the weights up to and with this group.
      std::uint32_t first = 0;  // Piece.
      std::uint32_t cluster = kOnePiece;
      Seen seen;  // Of one piece.
    };
    static constexpr std::uint32_t kOnePiece = 0xffffffff;
    struct Choice {
      std::uint32_t piece = 0;
      EmitterRange range;
      double probability = 1;
      double place = 0;  // What is left of the random number.
    };
    Seen See(std::size_t piece) const;
    SurfacePoint PlaceOn(std::size_t piece, double u) const;
    SurfacePoint MiddleOf(const Group& group) const;
    bool Choose(double u, Choice& choice) const;
    bool ChooseInLeaf(const EmitterTree::Leaf& leaf, Choice& choice) const;
    static bool ChooseAmong(std::span<const Seen> seen, std::uint32_t first, double total, double u, Choice& choice);
    bool Find(Choice& choice) const;
    bool FindInLeaf(const EmitterTree::Leaf& leaf, Choice& choice) const;
    std::optional<EmitterSample> SampleLength(const Choice& choice) const;

    const EmitterSampler& sampler_;
    const Vertex& vertex_;
    Spectrum certain_;
    std::uint32_t certain_pieces_ = 0;     // Bit by piece.
    std::array<Seen, kMostWeighed> seen_;  // By piece, if weighed.
    std::vector<Group> groups_;            // In the order of pieces, after a closer look.
    double total_ = 0;
    bool sufficient_ = false;
  };

 private:
  static constexpr std::uint32_t kNotAPiece = 0xffffffff;

  // Whether the light of a piece that is seen so is certain.
  bool IsCertain(std::size_t piece, const EmitterRange& range, const EmitterSight& sight) const {
    return weighs() && range.kind == EmitterRange::Kind::kSines && range.alone && ((sight.clear >> piece) & 1) != 0;
  }
  bool IsHidden(std::size_t piece, const EmitterSight& sight) const {
    return weighs() && ((sight.hidden >> piece) & 1) != 0;
  }

  void PlantTree();

  struct Piece {
    ElementId id = ElementId::kNone;
    Element element;
    EmittingSides sides = EmittingSides::kFront;
    Spectrum radiance;
    double brightness = 0;  // Largest channel.
  };

  std::shared_ptr<const Scene> scene_;
  EmitterTree tree_;                             // Where emitters are not weighed one by one.
  std::vector<Piece> pieces_;                    // In the order of the tree, or of elements.
  std::vector<std::uint32_t> piece_of_element_;  // kNotAPiece if it does not emit.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PATH_TRACING_EMITTER_SAMPLER_H_
