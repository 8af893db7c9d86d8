// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_JOB_ID_H_
#define FLATLIGHT_SERVER_STORE_JOB_ID_H_

#include <compare>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace flatlight {

// The {uuid} of jobs/{uuid}: 36 characters, lower case.
class JobId {
 public:
  JobId() = default;
  static JobId Random();
  // From "jobs/{uuid}"; nothing if the name has another form.
  static std::optional<JobId> FromName(std::string_view name);

  std::string Name() const { return "jobs/" + uuid_; }
  const std::string& uuid() const { return uuid_; }
  friend auto operator<=>(const JobId&, const JobId&) = default;

 private:
  std::string uuid_;
};

}  // namespace flatlight

template <>
struct std::hash<flatlight::JobId> {
  std::size_t operator()(const flatlight::JobId& id) const noexcept { return std::hash<std::string>()(id.uuid()); }
};

#endif  // FLATLIGHT_SERVER_STORE_JOB_ID_H_
