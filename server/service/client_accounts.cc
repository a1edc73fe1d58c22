#include "server/service/client_accounts.h"

#include <algorithm>

namespace terrane::server {

ClientAccounts::Seconds ClientAccounts::Wait(const std::string& client,
                                             Time now) const {
  std::lock_guard lock(mutex_);
  const auto found = full_at_.find(client);
  if (found == full_at_.end()) return Seconds(0);
  return std::max(found->second - kSaved - now, Seconds(0));
}

void ClientAccounts::Charge(const std::string& client, double amount,
                            Time now) {
  std::lock_guard lock(mutex_);
  // Now and then, so that a call pays for one entry on the average.
  if (full_at_.size() >= purge_at_) {
    std::erase_if(full_at_,
                  [now](const auto& entry) { return entry.second <= now; });
    purge_at_ = std::max(kLeastPurge, 2 * full_at_.size());
  }
  Time& full_at = full_at_.try_emplace(client, now).first->second;
  full_at = std::max(full_at, now) + Seconds(amount / per_second_);
}

std::size_t ClientAccounts::size() const {
  std::lock_guard lock(mutex_);
  return full_at_.size();
}

}  // namespace terrane::server
