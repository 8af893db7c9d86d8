// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_CONVERT_FOLLOW_UPS_H_
#define FLATLIGHT_SERVER_CONVERT_FOLLOW_UPS_H_

#include <string>
#include <vector>

#include "core/scene/diagnostic.h"
#include "flatlight/v1/scene.pb.h"

namespace flatlight {

// Tells mistakes of their own from mere consequences of mistakes that are reported already: when a field's name is
// misspelt, that the right one is missing is no news.
class FollowUps {
 public:
  // `earlier`: reported while `scene` was read, so that parts of it may be missing.
  FollowUps(const v1::Scene& scene, const Diagnostics& earlier);

  // True if a mistake at this path may come from an earlier one: one at the same place or inside of it; about an
  // object one of whose fields is wrong; about an absent field of an object that has an unknown field; about a name
  // that refers to an item whose own name is in doubt.
  bool MayExplain(const std::string& path) const;

 private:
  bool InDoubt(const std::string& path) const;

  std::vector<std::string> doubtful_;
  bool materials_in_doubt_ = false;
  bool curves_in_doubt_ = false;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_CONVERT_FOLLOW_UPS_H_
