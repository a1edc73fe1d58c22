// The few things that every use of GDAL here shares: registration, ownership,
// and its global error state turned into a Status. Threads: any; an error scope
// sees only its own thread's errors.
#ifndef TERRANE_CLIENT_GDAL_SUPPORT_H_
#define TERRANE_CLIENT_GDAL_SUPPORT_H_

#include <gdal_priv.h>

#include <memory>
#include <string>

#include "absl/status/status.h"

namespace terrane::client {

struct CloseDataset {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using DatasetPtr = std::unique_ptr<GDALDataset, CloseDataset>;

// Registers GDAL's drivers, once.
void RegisterGdal();

// While it lives, GDAL's errors on this thread go here instead of standard
// error.
class GdalErrorScope {
 public:
  GdalErrorScope();
  ~GdalErrorScope();
  GdalErrorScope(const GdalErrorScope&) = delete;
  GdalErrorScope& operator=(const GdalErrorScope&) = delete;

  bool failed() const { return !first_failure_.empty(); }
  // "action: reason", the reason being the first failure.
  absl::Status Error(const std::string& action) const;

 private:
  static void CPL_STDCALL Keep(CPLErr severity, CPLErrorNum number,
                               const char* message);
  std::string first_failure_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_GDAL_SUPPORT_H_
