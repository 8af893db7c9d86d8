// SPDX-License-Identifier: Apache-2.0
// How plans and their mistakes write numbers.
#ifndef FLATLIGHT_CORE_RENDER_PLAN_TEXT_H_
#define FLATLIGHT_CORE_RENDER_PLAN_TEXT_H_

#include <sstream>
#include <string>

namespace flatlight {

template <typename T>
std::string Text(const T& value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_PLAN_TEXT_H_
