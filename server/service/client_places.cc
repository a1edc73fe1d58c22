#include "server/service/client_places.h"

#include <mutex>
#include <unordered_map>

namespace terrane::server {

// Only clients with calls have an entry.
struct ClientPlaces::Counts {
  std::mutex mutex;
  std::unordered_map<std::string, int> calls;

  void GiveBack(const std::string& client) {
    std::lock_guard lock(mutex);
    const auto entry = calls.find(client);
    if (--entry->second == 0) calls.erase(entry);
  }
};

ClientPlaces::ClientPlaces(int most)
    : most_(most), counts_(std::make_shared<Counts>()) {}

std::shared_ptr<const void> ClientPlaces::Take(const std::string& client) {
  {
    std::lock_guard lock(counts_->mutex);
    int& calls = counts_->calls[client];
    if (calls >= most_) return nullptr;
    ++calls;
  }
  return std::shared_ptr<const void>(
      counts_.get(),
      [counts = counts_, client](const void*) { counts->GiveBack(client); });
}

}  // namespace terrane::server
