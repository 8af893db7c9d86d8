// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_SUPPORT_TRANSPORT_MISTAKES_H_
#define FLATLIGHT_TESTS_SUPPORT_TRANSPORT_MISTAKES_H_

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/render/plan.h"

namespace flatlight {

// "path: message" of all mistakes of settings. A failure if there is a plan in spite of them, or none without.
inline std::vector<std::string> Mistakes(const Scene& scene, const Settings& settings) {
  Diagnostics diagnostics;
  const bool planned = MakePlan(scene, settings, diagnostics).has_value();
  EXPECT_EQ(planned, diagnostics.empty());
  std::vector<std::string> mistakes;
  for (const Diagnostic& d : diagnostics.kept()) mistakes.push_back(d.path + ": " + d.message);
  return mistakes;
}

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_SUPPORT_TRANSPORT_MISTAKES_H_
