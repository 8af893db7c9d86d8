// SPDX-License-Identifier: Apache-2.0
// Direct irradiance by brute force in 113-bit arithmetic, and its derivatives by finite differences: slow, simple, and
// independent of every formula under test.
#ifndef FLATLIGHT_TESTS_CORE_PLANE_EXACT_ORACLE_H_
#define FLATLIGHT_TESTS_CORE_PLANE_EXACT_ORACLE_H_

#include <optional>
#include <vector>

#include "core/scene/description.h"

namespace flatlight {

__extension__ typedef __float128 Quad;

// World units. The first channel only.
struct OracleValue {
  double irradiance = 0;
  double gradient = 0;
  double hessian = 0;
  double size = 0;  // Sum of the sizes of the irradiance's terms, radiance times |sin| at both ends of each piece.
};

class Oracle {
 public:
  explicit Oracle(const SceneDescription& scene);

  // At a fraction of the arc length of a segment or arc. Absent if a visibility event is so near that differences mean
  // nothing.
  std::optional<OracleValue> OnCurve(std::size_t curve, double fraction, Side side) const;
  // At a free point; derivatives along (normal.y, -normal.x).
  std::optional<OracleValue> AtPoint(Point2 position, Vector2 normal) const;

 private:
  struct Place {
    Quad x, y, nx, ny, tx, ty;
  };
  struct Line {
    bool arc = false;
    Quad ax, ay, bx, by;                // Segment.
    Quad cx, cy, radius, start, sweep;  // Arc.
    Quad front = 0, back = 0;           // Radiance.
  };
  Quad Irradiance(const Place& place, Quad* size) const;
  // Distance along a direction; negative if missed. `front` tells the side that is seen.
  Quad Hit(const Line& line, const Place& place, Quad dx, Quad dy, bool* front) const;
  template <typename PlaceAt>
  std::optional<OracleValue> Differentiate(PlaceAt place_at) const;

  std::vector<Line> lines_;
  double scale_ = 1;
};

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_CORE_PLANE_EXACT_ORACLE_H_
