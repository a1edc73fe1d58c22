// ClientAccounts: how much of something each client may use a second in the
// long run: a token bucket a client. Filled at `per_second`, it holds what
// comes in kSaved, so that a client that kept still may come in a
// bunch. What is charged may overdraw it, since the cost of a call is known
// when it is over; the client then waits until the debt is paid.
//
// Threads: any.
#ifndef TERRANE_SERVER_SERVICE_CLIENT_ACCOUNTS_H_
#define TERRANE_SERVER_SERVICE_CLIENT_ACCOUNTS_H_

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>
#include <unordered_map>

namespace terrane::server {

class ClientAccounts {
 public:
  using Seconds = std::chrono::duration<double>;
  using Time = std::chrono::time_point<std::chrono::steady_clock, Seconds>;

  static constexpr Seconds kSaved{10};

  // `per_second` is above 0.
  explicit ClientAccounts(double per_second) : per_second_(per_second) {}

  double per_second() const { return per_second_; }
  // How long until the client's account holds something; 0 when it does.
  Seconds Wait(const std::string& client, Time now) const;
  // A negative amount is given back.
  void Charge(const std::string& client, double amount, Time now);
  // Accounts kept: a full one is forgotten sooner or later.
  std::size_t size() const;

 private:
  // Of so many accounts those that are full are forgotten.
  static constexpr std::size_t kLeastPurge = 1024;

  const double per_second_;
  mutable std::mutex mutex_;
  // When the account will be full again.
  std::unordered_map<std::string, Time> full_at_;
  std::size_t purge_at_ = kLeastPurge;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_CLIENT_ACCOUNTS_H_
