// A raw TCP client on loopback: sends the bytes it is told to, and reads what
// comes back.
#ifndef TERRANE_TESTS_SERVER_HTTP_EXCHANGE_H_
#define TERRANE_TESTS_SERVER_HTTP_EXCHANGE_H_

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <string_view>

namespace terrane::server {

class TcpClient {
 public:
  explicit TcpClient(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const void* const plain = &address;
    EXPECT_EQ(
        connect(socket_, static_cast<const sockaddr*>(plain), sizeof address),
        0);
  }
  ~TcpClient() { close(socket_); }
  TcpClient(const TcpClient&) = delete;
  TcpClient& operator=(const TcpClient&) = delete;

  // False once the other side has closed.
  bool Send(std::string_view bytes) const {
    return send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
           static_cast<ssize_t>(bytes.size());
  }

  // Waits for the first byte, which stays to be read, or the end.
  void AwaitReply() const {
    char byte = 0;
    recv(socket_, &byte, 1, MSG_PEEK);
  }

  // Everything until the other side closes.
  std::string ReadToEnd() const {
    std::string all;
    char part[4096];
    for (ssize_t got = 0; (got = recv(socket_, part, sizeof part, 0)) > 0;) {
      all.append(part, static_cast<std::size_t>(got));
    }
    return all;
  }

 private:
  const int socket_ = socket(AF_INET, SOCK_STREAM, 0);
};

// The whole reply to one request.
inline std::string HttpExchange(int port, std::string_view request) {
  const TcpClient client(port);
  client.Send(request);
  return client.ReadToEnd();
}

inline std::string HttpGet(int port, const std::string& path) {
  return HttpExchange(port,
                      "GET " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
}

// The content of a reply, after its header.
inline std::string HttpBody(const std::string& reply) {
  const std::size_t end = reply.find("\r\n\r\n");
  return end == reply.npos ? std::string() : reply.substr(end + 4);
}

}  // namespace terrane::server

#endif  // TERRANE_TESTS_SERVER_HTTP_EXCHANGE_H_
