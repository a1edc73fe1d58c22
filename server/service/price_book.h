// PriceBook: what calls cost on this machine, learnt from those that ended.
//
// Generators estimate a stream from what their units took so far (CostMeter);
// what a stream really took, its messages included, corrects that by method.
// Calls without an estimate are priced at the average of their method.
// Threads: any.
#ifndef TERRANE_SERVER_SERVICE_PRICE_BOOK_H_
#define TERRANE_SERVER_SERVICE_PRICE_BOOK_H_

#include <algorithm>
#include <map>
#include <mutex>
#include <string_view>

namespace terrane::server {

// Calls that cost more than this are batch work.
inline constexpr double kMostInteractiveSeconds = 1;

class PriceBook {
 public:
  // Seconds of one worker; `estimated` is 0 where there is none. `method` lives
  // as long as the program.
  double Price(std::string_view method, double estimated) const {
    std::lock_guard lock(mutex_);
    const auto found = entries_.find(method);
    const Entry entry = found == entries_.end() ? Entry() : found->second;
    return estimated > 0 ? estimated * entry.spent / entry.estimated
                         : entry.seconds;
  }

  // What an interactive stream of the method takes whose request is not read.
  double Typical(std::string_view method) const {
    std::lock_guard lock(mutex_);
    const auto found = entries_.find(method);
    return (found == entries_.end() ? Entry() : found->second).interactive;
  }

  // A call that came to its end took `spent`.
  void Learn(std::string_view method, double estimated, double spent) {
    std::lock_guard lock(mutex_);
    Entry& entry = entries_[method];
    entry.seconds += kWeight * (spent - entry.seconds);
    if (spent <= kMostInteractiveSeconds) {
      entry.interactive += kWeight * (spent - entry.interactive);
    }
    if (estimated <= 0) return;
    // Averages of both and not of their ratio: a tiny call that took ten times
    // as long as it should says little about a large one.
    const double bounded =
        std::clamp(spent, estimated / kMostRatio, estimated * kMostRatio);
    entry.spent += kWeight * (bounded - entry.spent);
    entry.estimated += kWeight * (estimated - entry.estimated);
  }

 private:
  // Weight of the newest call in the averages.
  static constexpr double kWeight = 1.0 / 16;
  // One strange call moves a price by this much, at most.
  static constexpr double kMostRatio = 16;

  struct Entry {
    double spent = 1e-3;        // of a call that was estimated,
    double estimated = 1e-3;    // and what was estimated of it
    double seconds = 1e-3;      // of a call
    double interactive = 1e-3;  // of an interactive call
  };

  mutable std::mutex mutex_;
  std::map<std::string_view, Entry> entries_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_PRICE_BOOK_H_
