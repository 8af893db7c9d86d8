// SPDX-License-Identifier: Apache-2.0
#include "server/webhook/webhook_transfer.h"

#include <netdb.h>
#include <unistd.h>

#include <array>
#include <utility>

namespace flatlight {
namespace {

constexpr std::size_t kMaxAnswerBytes = 64u << 10;  // More is not read: the status has come before.
constexpr long kGone = 410;

std::string TextOf(const sockaddr& address, socklen_t size) {
  std::array<char, NI_MAXHOST> text{};
  return getnameinfo(&address, size, text.data(), text.size(), nullptr, 0, NI_NUMERICHOST) == 0 ? text.data() : "?";
}

}  // namespace

WebhookTransfer::WebhookTransfer(const WebhookRules& rules, Message message, std::chrono::milliseconds connect_limit,
                                 std::chrono::milliseconds limit)
    : rules_(rules), message_(std::move(message)), handle_(curl_easy_init()) {
  CURL* curl = handle_.get();
  for (const std::string& header : message_.headers) {
    // A failure leaves the list as it was, which the receiver notices.
    if (curl_slist* longer = curl_slist_append(headers_.get(), header.c_str()); longer != nullptr) {
      static_cast<void>(headers_.release());  // It is the longer one's now.
      headers_.reset(longer);
    }
  }
  curl_easy_setopt(curl, CURLOPT_URL, message_.url.c_str());
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(curl, CURLOPT_DISALLOW_USERNAME_IN_URL, 1L);
  curl_easy_setopt(curl, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(curl, CURLOPT_PROXY, "");  // Not that of the environment either.
  curl_easy_setopt(curl, CURLOPT_NETRC, static_cast<long>(CURL_NETRC_IGNORED));
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT_MS, static_cast<long>(connect_limit.count()));
  curl_easy_setopt(curl, CURLOPT_TIMEOUT_MS, static_cast<long>(limit.count()));
  curl_easy_setopt(curl, CURLOPT_HTTPHEADER, headers_.get());
  curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(message_.body.size()));
  curl_easy_setopt(curl, CURLOPT_POSTFIELDS, message_.body.data());
  curl_easy_setopt(curl, CURLOPT_OPENSOCKETFUNCTION, &WebhookTransfer::OpenSocket);
  curl_easy_setopt(curl, CURLOPT_OPENSOCKETDATA, this);
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, &WebhookTransfer::Discard);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, this);
  curl_easy_setopt(curl, CURLOPT_FORBID_REUSE, 1L);  // A name that is looked up anew is checked anew.
  curl_easy_setopt(curl, CURLOPT_FRESH_CONNECT, 1L);
  curl_easy_setopt(curl, CURLOPT_PRIVATE, this);
}

curl_socket_t WebhookTransfer::OpenSocket(void* transfer, curlsocktype /*purpose*/, curl_sockaddr* address) {
  auto& self = *static_cast<WebhookTransfer*>(transfer);
  if (!self.rules_.AllowsAddress(address->addr)) {
    self.refused_address_ = TextOf(address->addr, address->addrlen);
    return CURL_SOCKET_BAD;
  }
  return socket(address->family, address->socktype | SOCK_CLOEXEC, address->protocol);
}

std::size_t WebhookTransfer::Discard(char* /*data*/, std::size_t size, std::size_t count, void* transfer) {
  auto& self = *static_cast<WebhookTransfer*>(transfer);
  self.answer_bytes_ += size * count;
  return self.answer_bytes_ > kMaxAnswerBytes ? 0 : size * count;
}

WebhookTransfer::Result WebhookTransfer::ResultOf(CURLcode code) const {
  long status = 0;
  curl_easy_getinfo(handle(), CURLINFO_RESPONSE_CODE, &status);
  const bool answered = code == CURLE_OK || (code == CURLE_WRITE_ERROR && answer_bytes_ > kMaxAnswerBytes);
  if (answered && status >= 200 && status < 300) return {Outcome::kTaken, ""};
  if (answered && status >= 300 && status < 400) {
    return {Outcome::kFailed, "answered with status " + std::to_string(status) + ": redirects are not followed"};
  }
  if (answered) {
    return {status == kGone ? Outcome::kRefused : Outcome::kFailed, "answered with status " + std::to_string(status)};
  }
  if (code == CURLE_COULDNT_CONNECT && !refused_address_.empty()) {
    return {Outcome::kRefused, "its name stands for " + refused_address_ +
                                   ", which is no public address, and which --webhook-allow does not name"};
  }
  return {Outcome::kFailed, curl_easy_strerror(code)};
}

}  // namespace flatlight
