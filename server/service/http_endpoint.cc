// Boost.Beast is slow to compile: it stays in this file.
#include "server/service/http_endpoint.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <deque>
#include <optional>
#include <thread>
#include <utility>

namespace terrane::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using Request = http::request_parser<http::empty_body>;
using Response = http::response<http::string_body>;

// How long to wait before the next try when a connection cannot be taken, as
// when the process is out of file descriptors.
constexpr std::chrono::milliseconds kAcceptRetry{100};
// What a client may still send after its reply.
constexpr std::size_t kLeftoverBytes = 64 * 1024;

Response ToResponse(const HttpReply& reply) {
  Response response(http::int_to_status(static_cast<unsigned>(reply.status)),
                    11);
  response.keep_alive(false);
  response.set(http::field::content_type, reply.content_type);
  response.body() = reply.body;
  response.prepare_payload();
  return response;
}

HttpReply ErrorReply(http::status status) {
  return {.status = static_cast<int>(status),
          .body = std::string(http::obsolete_reason(status)) + "\n"};
}

Response AnswerTo(const http::request<http::empty_body>& request,
                  const HttpPages& pages) {
  const bool head = request.method() == http::verb::head;
  if (!head && request.method() != http::verb::get) {
    Response refusal = ToResponse(ErrorReply(http::status::method_not_allowed));
    refusal.set(http::field::allow, "GET, HEAD");
    return refusal;
  }
  const std::string target(request.target());
  const auto page = pages.find(target.substr(0, target.find('?')));
  Response response =
      ToResponse(page == pages.end() ? ErrorReply(http::status::not_found)
                                     : page->second());
  if (head) response.body().clear();  // its length stays in the header
  return response;
}

// The answer to a request that could not be read; nothing when there is nobody
// to answer to.
std::optional<Response> AnswerTo(beast::error_code error) {
  if (error == http::error::header_limit ||
      error == http::error::buffer_overflow) {
    return ToResponse(
        ErrorReply(http::status::request_header_fields_too_large));
  }
  if (error == http::error::body_limit ||
      error == http::error::unexpected_body) {
    return ToResponse(ErrorReply(http::status::payload_too_large));
  }
  if (error == http::error::end_of_stream ||
      error == http::error::partial_message ||
      error.category() != make_error_code(http::error::bad_method).category()) {
    return std::nullopt;
  }
  return ToResponse(ErrorReply(http::status::bad_request));
}

// One connection: a request, a reply, the end. What is under way shares it.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, const HttpPages& pages,
             const HttpLimits& limits)
      : stream_(std::move(socket)),
        pages_(pages),
        limits_(limits),
        // Room for one header and no more.
        buffer_(limits.header_bytes) {
    request_.header_limit(limits.header_bytes);
    request_.body_limit(0);
  }

  void Start() {
    // Once for all of the request: bytes that trickle in buy no time.
    stream_.expires_after(limits_.time);
    http::async_read(
        stream_, buffer_, request_,
        [self = shared_from_this()](beast::error_code error, std::size_t) {
          self->Answer(error);
        });
  }

  // Whatever is under way fails.
  void Close() { stream_.close(); }

 private:
  void Answer(beast::error_code error) {
    std::optional<Response> response =
        error ? AnswerTo(error) : AnswerTo(request_.get(), pages_);
    if (!response.has_value()) return;
    response_ = *std::move(response);
    stream_.expires_after(limits_.time);
    http::async_write(
        stream_, response_,
        [self = shared_from_this()](beast::error_code failed, std::size_t) {
          if (failed) return;
          self->stream_.socket().shutdown(tcp::socket::shutdown_send, failed);
          self->ReadLeftover();
        });
  }

  // Closing a connection with unread bytes resets it, and the client might
  // lose its reply. So what still comes is read until the client has closed,
  // sent too much or taken too long.
  void ReadLeftover() {
    buffer_.clear();
    stream_.async_read_some(
        buffer_.prepare(buffer_.max_size()),
        [self = shared_from_this()](beast::error_code failed,
                                    std::size_t bytes) {
          self->leftover_bytes_ += bytes;
          if (!failed && self->leftover_bytes_ < kLeftoverBytes) {
            self->ReadLeftover();
          }
        });
  }

  beast::tcp_stream stream_;
  const HttpPages& pages_;
  const HttpLimits& limits_;
  beast::flat_buffer buffer_;
  Request request_;
  Response response_;
  std::size_t leftover_bytes_ = 0;
};

}  // namespace

// Takes connections, on a thread of its own.
class HttpEndpoint::Listener {
 public:
  Listener(HttpPages pages, HttpLimits limits)
      : pages_(std::move(pages)), limits_(limits) {}

  ~Listener() {
    io_.stop();
    if (thread_.joinable()) thread_.join();
  }

  absl::Status Start(const std::string& listen) {
    const std::size_t colon = listen.rfind(':');
    std::string host = listen.substr(0, colon);
    if (host.starts_with('[') && host.ends_with(']')) {
      host = host.substr(1, host.size() - 2);
    }
    beast::error_code failed;
    const auto found = tcp::resolver(io_).resolve(
        host, listen.substr(colon + 1), tcp::resolver::passive, failed);
    if (!failed) {
      const tcp::endpoint endpoint = found.begin()->endpoint();
      acceptor_.open(endpoint.protocol(), failed);
      // Connections of a server before this one may still be closing.
      acceptor_.set_option(tcp::acceptor::reuse_address(true), failed);
      acceptor_.bind(endpoint, failed);
    }
    if (!failed) {
      acceptor_.listen(tcp::acceptor::max_listen_connections, failed);
    }
    if (failed) {
      return absl::UnavailableError("cannot listen on " + listen + ": " +
                                    failed.message());
    }
    port_ = acceptor_.local_endpoint().port();
    Accept();
    thread_ = std::thread([this] { io_.run(); });
    return absl::OkStatus();
  }

  int port() const { return port_; }

 private:
  void Accept() {
    acceptor_.async_accept(
        [this](beast::error_code failed, tcp::socket socket) {
          if (!failed) {
            Take(std::move(socket));
            return Accept();
          }
          retry_.expires_after(kAcceptRetry);
          retry_.async_wait([this](beast::error_code) { Accept(); });
        });
  }

  void Take(tcp::socket socket) {
    std::erase_if(open_, [](const auto& one) { return one.expired(); });
    if (open_.size() >= limits_.connections) {
      if (const auto oldest = open_.front().lock()) oldest->Close();
      open_.pop_front();
    }
    const auto connection =
        std::make_shared<Connection>(std::move(socket), pages_, limits_);
    open_.push_back(connection);
    connection->Start();
  }

  const HttpPages pages_;
  const HttpLimits limits_;
  asio::io_context io_{1};
  tcp::acceptor acceptor_{io_};
  asio::steady_timer retry_{io_};
  std::deque<std::weak_ptr<Connection>> open_;  // oldest first
  int port_ = 0;
  std::thread thread_;
};

absl::StatusOr<std::unique_ptr<HttpEndpoint>> HttpEndpoint::Start(
    const std::string& listen, HttpPages pages, HttpLimits limits) {
  auto listener = std::make_unique<Listener>(std::move(pages), limits);
  const absl::Status started = listener->Start(listen);
  if (!started.ok()) return started;
  return std::unique_ptr<HttpEndpoint>(new HttpEndpoint(std::move(listener)));
}

HttpEndpoint::HttpEndpoint(std::unique_ptr<Listener> listener)
    : listener_(std::move(listener)) {}

HttpEndpoint::~HttpEndpoint() = default;

int HttpEndpoint::port() const { return listener_->port(); }

}  // namespace terrane::server
