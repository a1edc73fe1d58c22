// ClientPlaces: how many calls each client has at a time. Threads: any.
#ifndef TERRANE_SERVER_SERVICE_CLIENT_PLACES_H_
#define TERRANE_SERVER_SERVICE_CLIENT_PLACES_H_

#include <memory>
#include <string>

namespace terrane::server {

class ClientPlaces {
 public:
  // `most` calls a client.
  explicit ClientPlaces(int most);

  // A place for one more call, held until the last copy goes; null when the
  // client has none left. Places may outlive this.
  std::shared_ptr<const void> Take(const std::string& client);

 private:
  struct Counts;

  const int most_;
  const std::shared_ptr<Counts> counts_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_CLIENT_PLACES_H_
