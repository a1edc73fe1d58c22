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

// What both kinds share: the form, and how often it is shown.
class ProgressLine {
 public:
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

 protected:
  explicit ProgressLine(ProgressMode mode);
  // Removes the bar.
  ~ProgressLine();

  enum class Form { kNothing, kBar, kJson };

  // Whether to show now: at most ten times a second (JSON: once), and the last
  // step always.
  bool IsDue(bool last);
  double seconds() const;
  Form form() const { return form_; }
  void DrawBar(double share, const std::string& what) const;
  void PrintJson(const std::string& object) const;

 private:
  using Clock = std::chrono::steady_clock;

  const Form form_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point shown_;
};

// Of samples that are streamed, or of other units.
class Progress : private ProgressLine {
 public:
  Progress(ProgressMode mode, std::int64_t total, std::string unit = "samples");

  void Advance(std::int64_t units);

 private:
  const std::string unit_;
  const std::int64_t total_;
  std::int64_t done_ = 0;
};

// Of work of which a share is done.
class ShareProgress : private ProgressLine {
 public:
  // `key` names the share in JSON, `what` is done in words.
  ShareProgress(ProgressMode mode, const char* key, const char* what)
      : ProgressLine(mode), key_(key), what_(what) {}

  // `fraction` of the work is done, 0 to 1.
  void Show(double fraction);

 private:
  const char* const key_;
  const char* const what_;
};

// Of a recipe that is made ready.
class PreparationProgress : public ShareProgress {
 public:
  explicit PreparationProgress(ProgressMode mode)
      : ShareProgress(mode, "prepared", "meeting spot heights") {}
};

// "12.3 M": three digits and a unit of thousands.
std::string ShortNumber(double value);
// "1:02:03", "2:03".
std::string ClockText(double seconds);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_PROGRESS_H_
