// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_JOINT_RENDERING_H_
#define FLATLIGHT_CORE_RENDER_JOINT_RENDERING_H_

#include <memory>
#include <string>
#include <string_view>

#include "core/render/rendering.h"

namespace flatlight {

// Points and pictures of one scene, in turns of equal time.
class JointRendering final : public Rendering {
 public:
  JointRendering(std::unique_ptr<Rendering> points, std::unique_ptr<Rendering> pictures)
      : points_(std::move(points)), pictures_(std::move(pictures)) {}

  void Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
               Clock::Duration budget) override;
  bool done() const override { return points_->done() && pictures_->done(); }
  // That of the one that stopped short, if one did.
  EndReason end_reason() const override;
  RenderProgress Progress() const override;
  std::shared_ptr<const Field> Snapshot() const override;
  // Of whichever of the two has one; the other begins anew.
  std::string Checkpoint(std::size_t most_bytes) const override;
  bool Resume(std::string_view checkpoint) override;

 private:
  std::unique_ptr<Rendering> points_;
  std::unique_ptr<Rendering> pictures_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_JOINT_RENDERING_H_
