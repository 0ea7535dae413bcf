#include "tests/fuzz/canned_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <thread>

namespace voyager::fuzz {
namespace {

std::mutex replies_mutex;

void require(bool done) {
  if (!done) std::abort();
}

}  // namespace

CannedServer::CannedServer() {
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  require(listener_ >= 0);
  require(::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) == 0);
  require(::listen(listener_, 64) == 0);
  require(::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) == 0);
  const std::string url = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  for (const char* name : {"http_proxy", "https_proxy", "all_proxy"})
    ::setenv(name, url.c_str(), 1);
  for (const char* name : {"no_proxy", "NO_PROXY"}) ::unsetenv(name);
  std::thread(&CannedServer::serve, this).detach();
}

void CannedServer::answer(std::string_view replies, char separator) {
  const std::lock_guard lock(replies_mutex);
  replies_ = replies;
  separator_ = separator;
}

std::string CannedServer::next_reply() {
  const std::lock_guard lock(replies_mutex);
  const size_t end = std::min(replies_.find(separator_), replies_.size());
  std::string reply = replies_.substr(0, end);
  replies_.erase(0, std::min(end + 1, replies_.size()));
  return reply;
}

void CannedServer::serve() {
  for (;;) {
    const int connection = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (connection < 0) continue;
    serve_one(connection);
    ::close(connection);
  }
}

void CannedServer::serve_one(int connection) {
  const timeval wait = {1, 0};
  ::setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
  ::setsockopt(connection, SOL_SOCKET, SO_SNDTIMEO, &wait, sizeof wait);
  std::string request;
  char bytes[4096];
  while (request.find("\r\n\r\n") == std::string::npos) {
    const ssize_t got = ::recv(connection, bytes, sizeof bytes, 0);
    if (got <= 0) return;
    request.append(bytes, static_cast<size_t>(got));
  }
  const std::string reply = next_reply();
  for (size_t done = 0; done < reply.size();) {
    const ssize_t sent = ::send(connection, reply.data() + done, reply.size() - done, MSG_NOSIGNAL);
    if (sent <= 0) return;
    done += static_cast<size_t>(sent);
  }
}

}  // namespace voyager::fuzz
