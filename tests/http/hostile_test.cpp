// Servers that say nothing, or claim what they do not have, against `voyager` as a user runs it.
#include "tests/http/http_test.h"
#include "tests/support/hostile_files.h"
#include "tests/support/measured_run.h"
#include "tests/support/scripted_server.h"

namespace voyager::hostile_server_test {
namespace {

using namespace test;

// Serves what is there, and zeros behind it up to the length that it claims.
ScriptedServer::Script claiming(const ClaimedFile& file) {
  return [file](const ScriptedRequest& request) -> ScriptedReply {
    const uint64_t last = std::min(request.last, file.length - 1);
    std::string body(last - request.first + 1, '\0');
    for (uint64_t at = request.first; at <= last && at < file.head.size(); ++at)
      body[at - request.first] = static_cast<char>(file.head[at]);
    return {http_reply(206,
                       "Content-Range: bytes " + std::to_string(request.first) + "-" +
                           std::to_string(last) + "/" + std::to_string(file.length) + "\r\n",
                       body)};
  };
}

TEST(HostileServer, WhatItClaimsCostsLittle) {
  const Spent little = run_measured(program("voyager --version"));
  for (const ClaimedFile& file :
       {claimed_section(SectionKind::tiers, uint64_t{2} << 30),
        claimed_section(SectionKind::chunk_directory, uint64_t{2} << 30),
        claimed_chunks(Quality::compact, 100), claimed_chunks(Quality::lossless, 600)}) {
    ScriptedServer server(claiming(file));
    expect_cheap_refusal(run_measured(program("voyager info " + server.url())), little);
  }
}

// Three seconds, because a second is the least that can be asked for, and three of these the time
// of a read.
TEST(HostileServer, OneThatSaysNothingEndsWithTheTimeThatTheUserSays) {
  ScriptedServer server([](const ScriptedRequest&) -> ScriptedReply { return {"", false, true}; });
  const Timer timer;
  const Outcome found =
      run_shell("VOYAGER_HTTP_TIMEOUT=1 " + program("voyager info " + server.url()));
  EXPECT_GE(timer.elapsed(), 2s);
  EXPECT_LT(timer.elapsed(), 6s);
  EXPECT_EQ(found.exit_code, 4) << found.output;
  for (const char* part :
       {"a try ends after 1 s without a byte, a read after 3 s, which are three tries",
        "VOYAGER_HTTP_TIMEOUT sets the seconds of a try", "; 3 tries"})
    EXPECT_NE(found.output.find(part), std::string::npos) << part << "\n" << found.output;
}

TEST(HostileServer, ATimeThatIsNoneIsRefused) {
  for (const char* time : {"0", "-1", "1.5", "3601", "x", "99999999999"}) {
    const Outcome found = run_shell(std::string("VOYAGER_HTTP_TIMEOUT=") + time + " " +
                                    program("voyager info http://127.0.0.1:1/scene.voy"));
    EXPECT_EQ(found.exit_code, 1) << found.output;
    EXPECT_NE(found.output.find(std::string("found \"") + time + "\""), std::string::npos)
        << found.output;
  }
}

}  // namespace
}  // namespace voyager::hostile_server_test
