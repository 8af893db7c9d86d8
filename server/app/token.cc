// SPDX-License-Identifier: Apache-2.0
#include "server/app/token.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace flatlight {

absl::StatusOr<std::string> ReadTokenFile(const std::string& path) {
  std::ifstream file(path);
  if (!file) return absl::NotFoundError("cannot read the token file " + path + ": " + std::strerror(errno));
  std::string token;
  std::getline(file, token);
  if (token.empty()) return absl::InvalidArgumentError("the first line of the token file " + path + " is empty");
  return token;
}

std::string TakeTokenFromEnvironment() {
  const char* value = std::getenv("FLATLIGHT_TOKEN");
  std::string token = value == nullptr ? "" : value;
  unsetenv("FLATLIGHT_TOKEN");
  return token;
}

}  // namespace flatlight
