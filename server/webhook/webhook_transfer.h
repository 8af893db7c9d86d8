// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_WEBHOOK_WEBHOOK_TRANSFER_H_
#define FLATLIGHT_SERVER_WEBHOOK_WEBHOOK_TRANSFER_H_

#include <curl/curl.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "server/webhook/webhook_rules.h"

namespace flatlight {

// One POST over HTTP, to be driven by a multi handle of libcurl. Follows no redirect, uses no proxy, and connects to no
// address that the rules do not allow.
class WebhookTransfer {
 public:
  struct Message {
    std::string url;
    std::string body;
    std::vector<std::string> headers;  // "name: value".
  };
  enum class Outcome : std::uint8_t {
    kTaken,    // The receiver answered with a status of 200 to 299.
    kFailed,   // To be tried again.
    kRefused,  // Not to be tried again: the receiver is gone (status 410), or its address is not allowed.
  };
  struct Result {
    Outcome outcome = Outcome::kFailed;
    std::string error;  // Unless it was taken.
  };

  // `rules` outlives this.
  WebhookTransfer(const WebhookRules& rules, Message message, std::chrono::milliseconds connect_limit,
                  std::chrono::milliseconds limit);
  WebhookTransfer(const WebhookTransfer&) = delete;
  WebhookTransfer& operator=(const WebhookTransfer&) = delete;

  // To be added to a multi handle, and removed from it before this is destroyed.
  CURL* handle() const { return handle_.get(); }
  // What came of it, after the multi handle said that it is done.
  Result ResultOf(CURLcode code) const;

 private:
  static curl_socket_t OpenSocket(void* transfer, curlsocktype purpose, curl_sockaddr* address);
  static std::size_t Discard(char* data, std::size_t size, std::size_t count, void* transfer);

  struct FreeHandle {
    void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
  };
  struct FreeList {
    void operator()(curl_slist* list) const { curl_slist_free_all(list); }
  };

  const WebhookRules& rules_;
  const Message message_;
  std::string refused_address_;
  std::size_t answer_bytes_ = 0;
  std::unique_ptr<curl_slist, FreeList> headers_;
  std::unique_ptr<CURL, FreeHandle> handle_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_WEBHOOK_WEBHOOK_TRANSFER_H_
