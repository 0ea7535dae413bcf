#pragma once
// A proxy on loopback that answers every request with the next of some replies, and then hangs up:
// whatever host a reply redirects to, no byte leaves the machine.
#include <string>
#include <string_view>

namespace voyager::fuzz {

class CannedServer {
 public:
  // Makes itself the proxy of this process.
  CannedServer();
  // What requests from now on are answered with, in order; without one left, a request gets
  // nothing.
  void answer(std::string_view replies, char separator);

 private:
  void serve();
  void serve_one(int connection);
  std::string next_reply();

  int listener_ = -1;
  std::string replies_;
  char separator_ = 0;
};

}  // namespace voyager::fuzz
