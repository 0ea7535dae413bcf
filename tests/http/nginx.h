#pragma once
// The distribution's nginx, unprivileged, on a free port of loopback, with everything of it in a
// folder that vanishes.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <thread>

#include "tests/support/needs.h"
#include "tests/support/test_support.h"

namespace voyager::test {

// The program's path, "" where it is not here. scripts/unpack_nginx.sh fills build/nginx.
inline std::string program_path(const std::string& name) {
  for (const char* folder : {"/usr/sbin/", "/usr/bin/", "/usr/local/sbin/", "/usr/local/bin/",
                             VOYAGER_SOURCE_DIR "/build/nginx/usr/sbin/"})
    if (::access((folder + name).c_str(), X_OK) == 0) return folder + name;
  return "";
}

// Of one that no one listens on now.
inline int free_port() {
  const int probe = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in at = {};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof at;
  ::bind(probe, reinterpret_cast<sockaddr*>(&at), size);
  ::getsockname(probe, reinterpret_cast<sockaddr*>(&at), &size);
  ::close(probe);
  return ntohs(at.sin_port);
}

class Nginx {
 public:
  Nginx() { std::filesystem::create_directory(folder_.file("files")); }
  ~Nginx() { stop(); }
  Nginx(const Nginx&) = delete;
  Nginx& operator=(const Nginx&) = delete;

  // A file that is served, of a date of its own: nginx's ETag is date and size.
  void serve(const std::string& name, const std::string& bytes, int age_seconds = 0) const {
    const std::string path = folder_.file("files/" + name), fresh = path + ".new";
    std::ofstream(fresh, std::ios::binary) << bytes;
    namespace fs = std::filesystem;
    fs::last_write_time(fresh,
                        fs::file_time_type::clock::now() - std::chrono::seconds(age_seconds));
    fs::rename(fresh, path);
  }

  // In the background, with `server` in its server block and `listen` behind the port; returns
  // when it takes connections. "" or what it said.
  std::string start(const std::string& server = "", const std::string& listen = "") {
    port_ = free_port();
    std::ofstream(folder_.file("nginx.conf")) << configuration(server, listen);
    return restart();
  }
  // The same, on the port of before.
  std::string start_again(const std::string& server) {
    std::ofstream(folder_.file("nginx.conf")) << configuration(server, "");
    return restart();
  }
  std::string restart() {
    const std::string program = program_path("nginx"), root = folder_.file("");
    const std::string log = folder_.file("error.log"), conf = folder_.file("nginx.conf");
    const char* const arguments[] = {program.c_str(), "-p", root.c_str(), "-c",
                                     conf.c_str(),    "-e", log.c_str(),  nullptr};
    process_ = ::fork();
    if (process_ == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // however this test ends
      ::execv(program.c_str(), const_cast<char* const*>(arguments));
      ::_exit(127);
    }
    for (int tries = 0; tries < 500; ++tries) {
      if (takes_connections()) return "";
      if (::waitpid(process_, nullptr, WNOHANG) == process_) {
        process_ = 0;
        break;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return "nginx did not start: " + text_of("error.log");
  }
  // At once: transfers in flight are cut off.
  void stop() {
    if (process_ == 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
    process_ = 0;
  }

  std::string url(const std::string& path, const std::string& scheme = "http") const {
    return scheme + "://127.0.0.1:" + std::to_string(port_) + "/" + path;
  }
  std::string folder(const std::string& name) const { return folder_.file(name); }

  // A line a request, once there are `count`: connection, protocol, status, path.
  std::vector<std::string> requests(size_t count) const {
    std::vector<std::string> lines;
    for (int tries = 0; tries < 300 && lines.size() < count; ++tries) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      std::istringstream log(text_of("access.log"));
      lines.clear();
      for (std::string line; std::getline(log, line);) lines.push_back(line);
    }
    return lines;
  }

 private:
  std::string configuration(const std::string& server, const std::string& listen) const {
    std::string temporary;
    for (const char* kind : {"client_body", "proxy", "fastcgi", "uwsgi", "scgi"})
      temporary += std::string(kind) + "_temp_path " + kind + ";\n";
    return "daemon off;\nmaster_process off;\npid nginx.pid;\nevents { }\nhttp {\n" + temporary +
           "log_format ours '$connection $server_protocol $status $uri';\n"
           "access_log access.log ours;\nserver {\nlisten 127.0.0.1:" +
           std::to_string(port_) + " " + listen + ";\nroot files;\n" + server + "\n}\n}\n";
  }
  bool takes_connections() const {
    const int probe = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in at = {};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    at.sin_port = htons(static_cast<uint16_t>(port_));
    const bool taken = ::connect(probe, reinterpret_cast<sockaddr*>(&at), sizeof at) == 0;
    ::close(probe);
    return taken;
  }
  std::string text_of(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder_.file(name)).rdbuf();
    return text.str();
  }

  TempFolder folder_;
  int port_ = 0;
  pid_t process_ = 0;
};

// Of the first word of each line.
inline size_t different_first_words(const std::vector<std::string>& lines) {
  std::set<std::string> words;
  for (const std::string& line : lines) words.insert(line.substr(0, line.find(' ')));
  return words.size();
}

#define VOYAGER_NEEDS_NGINX()                       \
  if (voyager::test::program_path("nginx").empty()) \
  VOYAGER_SKIP_WITHOUT(NGINX, "nginx is not here: scripts/setup.sh tests brings it")

}  // namespace voyager::test
