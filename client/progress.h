// Progress of a long command on standard error: a bar with rate and time left
// on a terminal, JSON lines for programs, or nothing. Belongs to one thread.
#ifndef TERRANE_CLIENT_PROGRESS_H_
#define TERRANE_CLIENT_PROGRESS_H_

#include <chrono>
#include <cstdint>
#include <string>

namespace terrane::client {

// kAuto: a bar when standard error is a terminal, else nothing, so that logs
// stay readable.
enum class ProgressMode { kAuto, kNone, kJson };

class Progress {
 public:
  Progress(ProgressMode mode, std::int64_t total_samples);
  // Removes the bar.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Shows at most ten times a second (JSON: once), and the last step always.
  void Advance(std::int64_t samples);

 private:
  using Clock = std::chrono::steady_clock;
  enum class Form { kNothing, kBar, kJson };

  void DrawBar(double seconds) const;
  void PrintJson(double seconds) const;

  Form form_;
  std::int64_t total_;
  std::int64_t done_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_;
};

// "12.3 M": three digits and a unit of thousands.
std::string ShortNumber(double value);
// "1:02:03", "2:03".
std::string ClockText(double seconds);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_PROGRESS_H_
