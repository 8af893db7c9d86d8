// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SCHEDULER_ACCOUNTS_H_
#define FLATLIGHT_SERVER_SCHEDULER_ACCOUNTS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "server/store/job_class.h"

namespace flatlight {

// What each user has attained of the server: processor time. Who has attained least comes first.
//
// Only those who have jobs at the same time are weighed against each other: who comes, or comes back, starts level with
// the least served of those who are there (start-time fair queueing: Goyal, Vin, Cheng 1996), so that neither an hour
// of absence is a credit to displace others by, nor an hour alone on the server a debt.
class Accounts {
 public:
  using Rank = std::pair<double, std::uint64_t>;  // Attained, then who was served longest ago. The least comes first.

  // A job of the user begins to be, or has ended.
  void Enter(const std::string& user);
  void Leave(const std::string& user);

  // The user's turn has come; what it cost is told later.
  void Serve(const std::string& user);
  void Charge(const std::string& user, double cpu_seconds);

  // One of the user's jobs begins to hold one of the server's places, or gives it back.
  void TakePlace(const std::string& user, JobClass job_class);
  void GivePlace(const std::string& user, JobClass job_class);
  // Held by jobs of the class and of more urgent ones.
  std::size_t PlacesOf(const std::string& user, JobClass job_class) const;
  std::size_t places() const { return all_places_; }

  // Of a user who is not there: as if they came now.
  Rank RankOf(const std::string& user) const;
  // Of those who wait for a place: who holds fewest of them comes first.
  using PlaceRank = std::pair<std::size_t, Rank>;  // PlacesOf, then RankOf.
  PlaceRank PlaceRankOf(const std::string& user, JobClass job_class) const {
    return {PlacesOf(user, job_class), RankOf(user)};
  }

 private:
  struct Account {
    std::size_t jobs = 0;
    double attained = 0;     // s.
    std::uint64_t turn = 0;  // The last one.
  };

  double LeastAttained() const;

  std::map<std::string, Account> accounts_;  // Of those who have jobs.
  using Places = std::array<std::size_t, kJobClasses>;
  std::map<std::string, Places> places_;  // None of them without any.
  std::size_t all_places_ = 0;
  // Of those who have left with more than the level: what they had. Coming and going clears no debt.
  std::map<std::string, double> absent_;
  double level_ = 0;  // At which newcomers start: the least attained when somebody last came or went.
  std::uint64_t turns_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SCHEDULER_ACCOUNTS_H_
