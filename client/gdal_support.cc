#include "client/gdal_support.h"

#include <mutex>

namespace terrane::client {

namespace {

// Blocks that GDAL keeps before it writes them. Its default grows with the
// machine; ours holds one row of tiles of a large export.
constexpr GIntBig kCacheBytes = 64 << 20;

}  // namespace

void RegisterGdal() {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALAllRegister();
    GDALSetCacheMax64(kCacheBytes);
  });
}

GdalErrorScope::GdalErrorScope() { CPLPushErrorHandlerEx(Keep, this); }

GdalErrorScope::~GdalErrorScope() { CPLPopErrorHandler(); }

void GdalErrorScope::Keep(CPLErr severity, CPLErrorNum, const char* message) {
  auto* scope = static_cast<GdalErrorScope*>(CPLGetErrorHandlerUserData());
  if (severity >= CE_Failure && scope->first_failure_.empty()) {
    scope->first_failure_ = message;
  }
}

absl::Status GdalErrorScope::Error(const std::string& action) const {
  return absl::UnknownError(
      action + ": " + (failed() ? first_failure_ : "GDAL gives no reason"));
}

}  // namespace terrane::client
