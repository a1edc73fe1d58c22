// A report of `terrane bench` as one page that stands alone: no script, nothing
// fetched from elsewhere, light and dark as the reader's system is. A pure
// function.
#ifndef TERRANE_CLIENT_BENCH_HTML_REPORT_H_
#define TERRANE_CLIENT_BENCH_HTML_REPORT_H_

#include <string>

#include "client/bench_report.pb.h"

namespace terrane::client {

std::string HtmlReport(const BenchReport& report);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_HTML_REPORT_H_
