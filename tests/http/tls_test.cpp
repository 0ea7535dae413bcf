// HTTPS and HTTP/2, on nginx with certificates of a CA that the test makes.
#include <cstdlib>

#include "tests/http/http_test.h"
#include "tests/http/nginx.h"
#include "tests/support/scripted_server.h"

namespace voyager::tls_test {
namespace {

using namespace test;

class OnTls : public testing::Test {
 protected:
  void SetUp() override {
    VOYAGER_NEEDS_NGINX();
    if (program_path("openssl").empty())
      VOYAGER_SKIP_WITHOUT(NGINX, "openssl is not here: scripts/setup.sh tests brings it");
    make_certificates();
    nginx_.serve("scene.voy", file_);
  }
  ~OnTls() override {
    for (const char* name : {"CURL_CA_BUNDLE", "SSL_CERT_FILE", "SSL_CERT_DIR"}) ::unsetenv(name);
  }

  // ca.pem vouches for server.pem, which is for 127.0.0.1 and nothing else; other.pem is a CA too.
  void make_certificates() {
    const std::string folder = nginx_.folder("");
    const std::string key = " -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 2 ";
    std::ofstream(nginx_.folder("san.cnf")) << "subjectAltName=IP:127.0.0.1\n";
    const std::string commands[] = {
        "req -x509" + key + "-subj /CN=ours -keyout ca.key -out ca.pem",
        "req -x509" + key + "-subj /CN=another -keyout other.key -out other.pem",
        "req" + key + "-subj /CN=server -keyout server.key -out server.csr",
        "x509 -req -in server.csr -CA ca.pem -CAkey ca.key -CAcreateserial -days 2 -extfile "
        "san.cnf -out server.pem"};
    for (const std::string& command : commands)
      ASSERT_EQ(
          std::system(("cd " + folder + " && openssl " + command + " >>openssl.log 2>&1").c_str()),
          0)
          << command;
  }
  std::string start(const std::string& protocols) {
    return nginx_.start("ssl_certificate server.pem; ssl_certificate_key server.key;",
                        "ssl " + protocols);
  }
  std::string url() const { return nginx_.url("scene.voy", "https"); }

  const std::string file_ = random_text(500'000);
  Nginx nginx_;
};

TEST_F(OnTls, AnUnknownAuthorityIsRefused) {
  ASSERT_EQ(start(""), "");
  expect_error(ErrorCode::io, "certificate", [&] { http::Source(url(), quick()); });
  ::setenv("CURL_CA_BUNDLE", nginx_.folder("other.pem").c_str(), 1);
  expect_error(ErrorCode::io, "certificate", [&] { http::Source(url(), quick()); });
  ::setenv("CURL_CA_BUNDLE", nginx_.folder("none.pem").c_str(), 1);
  expect_error(ErrorCode::io, "certificate", [&] { http::Source(url(), quick()); });
}

TEST_F(OnTls, TheVariablesThatNameAnAuthorityAreHonoured) {
  ASSERT_EQ(start(""), "");
  for (const char* name : {"CURL_CA_BUNDLE", "SSL_CERT_FILE"}) {
    ::setenv(name, nginx_.folder("ca.pem").c_str(), 1);
    const http::Source source(url(), quick());
    EXPECT_EQ(read(source, 300'000, 1'000), file_.substr(300'000, 1'000)) << name;
    ::unsetenv(name);
  }
}

TEST_F(OnTls, ACertificateForAnotherHostIsRefused) {
  ASSERT_EQ(start(""), "");
  ::setenv("CURL_CA_BUNDLE", nginx_.folder("ca.pem").c_str(), 1);
  std::string other = url();
  other.replace(other.find("127.0.0.1"), 9, "localhost");
  expect_error(ErrorCode::io, "certificate", [&] { http::Source(other, quick()); });
}

TEST_F(OnTls, Http2IsUsedWhereTheServerHasIt) {
  ASSERT_EQ(start("http2"), "");
  ::setenv("CURL_CA_BUNDLE", nginx_.folder("ca.pem").c_str(), 1);
  const http::Source source(url(), quick());
  for (size_t at = 70'000; at < 400'000; at += 50'000)
    EXPECT_EQ(read(source, at, 50'000), file_.substr(at, 50'000));
  const auto requests = nginx_.requests(8);
  ASSERT_EQ(requests.size(), 8u);
  for (const std::string& request : requests)
    EXPECT_NE(request.find("HTTP/2.0 206"), std::string::npos) << request;
  EXPECT_EQ(different_first_words(requests), 1u);
}

TEST_F(OnTls, ARestartIsBridged) {
  ASSERT_EQ(start("http2"), "");
  ::setenv("CURL_CA_BUNDLE", nginx_.folder("ca.pem").c_str(), 1);
  const http::Source source(url(), quick());
  EXPECT_EQ(read(source, 100'000, 9), file_.substr(100'000, 9));
  nginx_.stop();
  ASSERT_EQ(nginx_.restart(), "");
  EXPECT_EQ(read(source, 200'000, 9), file_.substr(200'000, 9));
}

TEST_F(OnTls, ASecureUrlIsNotRedirectedToAnInsecureOne) {
  ScriptedServer insecure([](const ScriptedRequest&) { return ScriptedReply{"", true}; });
  ASSERT_EQ(nginx_.start("ssl_certificate server.pem; ssl_certificate_key server.key; return 302 " +
                             insecure.url() + ";",
                         "ssl"),
            "");
  ::setenv("CURL_CA_BUNDLE", nginx_.folder("ca.pem").c_str(), 1);
  expect_error(ErrorCode::refused_input, "Protocol", [&] { http::Source(url(), quick()); });
  EXPECT_EQ(insecure.requests(), 0);
}

TEST(Tls, APlainServerIsNoTlsServer) {
  ScriptedServer server([](const ScriptedRequest&) { return ScriptedReply{"", true}; });
  std::string url = server.url();
  http::Options options = impatient();
  options.tries = 1;
  expect_error(ErrorCode::io_transient, "1 try",
               [&] { http::Source(url.insert(4, "s"), options); });
}

TEST(Tls, TheProxyOfHttpsIsAsked) {
  std::string asked;
  ScriptedServer proxy([&](const ScriptedRequest& request) {
    asked = request.text.substr(0, request.text.find('\r'));
    return ScriptedReply{http_reply(403, "", ""), true};
  });
  ::setenv("https_proxy", proxy.url("").c_str(), 1);
  EXPECT_THROW(http::Source("https://voyager.invalid/scene.voy", quick()), Error);
  ::unsetenv("https_proxy");
  EXPECT_EQ(asked, "CONNECT voyager.invalid:443 HTTP/1.1");
}

}  // namespace
}  // namespace voyager::tls_test
