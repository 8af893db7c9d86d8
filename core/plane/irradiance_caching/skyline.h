// SPDX-License-Identifier: Apache-2.0
// Everything that shines on a receiver straight away, in the order of directions, with derivatives along the receiver.
#ifndef FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_SKYLINE_H_
#define FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_SKYLINE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/cache/record.h"
#include "core/plane/exact/edge.h"
#include "core/plane/irradiance_caching/reflected_series.h"
#include "core/plane/ray_caster.h"
#include "core/plane/reference/chart.h"
#include "core/plane/reference/outlook.h"
#include "core/scene/scene.h"

namespace flatlight {

// Holds working memory: one for each thread.
class Skyline {
 public:
  // `reflects`: curves that reflect shine too, each as it likes; then two curves are never of equal radiance. Both
  // others must outlive this.
  // `reflected`, if not null: what they shine.
  Skyline(const RayCaster& caster, const std::vector<Chart>& charts, bool reflects,
          const ReflectedSeries* reflected = nullptr);

  // Looks around from there; what follows is about the last look.
  void LookFrom(const Receiver& receiver);

  // Irradiance and its derivatives, of direct light and what is known to be reflected; exact where no visibility event
  // happens, and there those of the right side.
  std::array<Spectrum, kRecordOrders> Irradiance() const;
  // Whether that is all there is.
  bool knows_all() const { return reflected_ != nullptr || !reflects_; }
  // Sets `radiometric`, of the same light, `geometric` and `turning`.
  void Survey(Surroundings& surroundings) const;
  // Tells what is seen: equal as long as irradiance is a smooth function of the place.
  std::uint64_t Signature() const { return signature_; }

 private:
  // From a direction on there is another radiance.
  struct Break {
    Edge edge;
    Spectrum before, after;
  };
  void AddBreak(const Edge& edge, const Spectrum& after, std::uint64_t owner, std::uint64_t identity);
  void Sign(std::uint64_t what);
  // Which stretches of its light, between kinks, the ends of what is seen lie in.
  void SignKinks(const VisiblePiece& piece);
  std::uint64_t IdentityOf(const VisiblePiece& piece, const Spectrum& radiance) const;
  std::uint64_t OwnerOf(const Edge& edge, const VisiblePiece* before, const VisiblePiece* after) const;
  // The second derivative of the sine of the direction to a fixed point of what is seen.
  double FixedSecond(const VisiblePiece& piece, const PieceEnd& end) const;

  const RayCaster& caster_;
  const Scene& scene_;
  const std::vector<Chart>& charts_;
  const bool reflects_;
  const ReflectedSeries* reflected_;
  Outlook outlook_;
  Receiver receiver_;
  const std::vector<VisiblePiece>* pieces_ = nullptr;
  std::vector<Break> breaks_;
  std::array<Spectrum, kRecordOrders> lights_;
  Spectrum radiance_;           // Up to the last break.
  std::uint64_t identity_ = 0;  // Of what has it.
  std::uint64_t signature_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_SKYLINE_H_
