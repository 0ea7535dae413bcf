#pragma once
// An HTTP server of a few lines that answers as a test says: what no real server can be brought
// to do. HTTP/1.1 on loopback, a thread a connection, GET requests only.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace voyager::test {

struct ScriptedRequest {
  std::string text;              // its head, as it came
  int number = 0;                // from 0, over all connections
  uint64_t first = 0, last = 0;  // of its Range header; 0 without one
};

struct ScriptedReply {
  std::string bytes;   // what is sent
  bool close = false;  // then the connection ends
  bool stall = false;  // then nothing more comes, until the server or the client ends
};

class ScriptedServer {
 public:
  using Script = std::function<ScriptedReply(const ScriptedRequest&)>;

  // `script` is called by the connections' threads, one at a time.
  explicit ScriptedServer(Script script) : script_(std::move(script)) {
    listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in at = {};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    EXPECT_EQ(::bind(listener_, reinterpret_cast<sockaddr*>(&at), size), 0);
    EXPECT_EQ(::listen(listener_, 64), 0);
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&at), &size);
    port_ = ntohs(at.sin_port);
    acceptor_ = std::thread([this] { accept_all(); });
  }
  ~ScriptedServer() {
    ends_ = true;
    acceptor_.join();
    for (std::thread& connection : connections_) connection.join();
    ::close(listener_);
  }
  ScriptedServer(const ScriptedServer&) = delete;
  ScriptedServer& operator=(const ScriptedServer&) = delete;

  std::string url(const std::string& path = "/scene.voy") const {
    return "http://127.0.0.1:" + std::to_string(port_) + path;
  }
  int port() const { return port_; }
  int requests() const { return requests_; }
  int connections() const { return static_cast<int>(accepted_); }

 private:
  // Is there something to read within 10 ms?
  static bool ready(int socket) {
    pollfd waiting = {socket, POLLIN, 0};
    return ::poll(&waiting, 1, 10) > 0;
  }

  void accept_all() {
    while (!ends_) {
      if (!ready(listener_)) continue;
      const int socket = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      if (socket < 0) continue;
      ++accepted_;
      connections_.emplace_back([this, socket] {
        while (!ends_ && serve(socket)) {
        }
        ::close(socket);
      });
    }
  }

  // One request; false where the connection ends.
  bool serve(int socket) {
    ScriptedRequest request;
    while (request.text.find("\r\n\r\n") == std::string::npos) {
      if (ends_) return false;
      if (!ready(socket)) continue;
      char buffer[4096];
      const ssize_t got = ::recv(socket, buffer, sizeof buffer, 0);
      if (got <= 0) return false;
      request.text.append(buffer, static_cast<size_t>(got));
    }
    read_range(request);
    const ScriptedReply reply = answer(request);
    if (!send_all(socket, reply.bytes)) return false;
    while (reply.stall && !ends_) {
      char byte;
      if (ready(socket) && ::recv(socket, &byte, 1, 0) <= 0) return false;
    }
    return !reply.close;
  }

  static void read_range(ScriptedRequest& request) {
    const size_t at = request.text.find("Range: bytes=");
    if (at == std::string::npos) return;
    char* end = nullptr;
    request.first = std::strtoull(request.text.c_str() + at + 13, &end, 10);
    request.last = std::strtoull(end + 1, nullptr, 10);
  }

  ScriptedReply answer(ScriptedRequest& request) {
    const std::lock_guard lock(mutex_);
    request.number = requests_++;
    return script_(request);
  }

  static bool send_all(int socket, const std::string& bytes) {
    for (size_t sent = 0; sent < bytes.size();) {
      const ssize_t put = ::send(socket, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (put <= 0) return false;
      sent += static_cast<size_t>(put);
    }
    return true;
  }

  Script script_;
  std::mutex mutex_;
  std::atomic<int> requests_{0}, accepted_{0};
  std::atomic<bool> ends_{false};
  int listener_ = -1, port_ = 0;
  std::thread acceptor_;
  std::vector<std::thread> connections_;  // the acceptor's, until it has ended
};

// An answer with `body`. `headers` are whole lines.
inline std::string http_reply(int status, const std::string& headers, const std::string& body) {
  return "HTTP/1.1 " + std::to_string(status) + " Scripted\r\n" + headers +
         "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

// A 206 for the request, as a sound server gives it. Out of range is not told from in range.
inline std::string part_of(const std::string& file, const ScriptedRequest& request,
                           const std::string& more_headers = "") {
  const uint64_t last = std::min<uint64_t>(request.last, file.size() - 1);
  return http_reply(206,
                    "Content-Range: bytes " + std::to_string(request.first) + "-" +
                        std::to_string(last) + "/" + std::to_string(file.size()) + "\r\n" +
                        more_headers,
                    file.substr(request.first, last - request.first + 1));
}

}  // namespace voyager::test
