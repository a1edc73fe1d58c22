// Fields where 0 means the default.
#ifndef TERRANE_SERVER_CONVERT_NON_ZERO_H_
#define TERRANE_SERVER_CONVERT_NON_ZERO_H_

namespace terrane::server {

// Leaves the default where the message has none.
template <typename Number>
void ReadNonZero(Number value, Number* field) {
  if (value != 0) *field = value;
}

}  // namespace terrane::server

#endif  // TERRANE_SERVER_CONVERT_NON_ZERO_H_
