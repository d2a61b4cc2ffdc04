#include "host_app/web/web_server.h"

#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/free_ports.h"
#include "tests/support/http_answer.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/ports/local_caller.h"

namespace vantage {
namespace {

class WebServerTest : public testing::Test {
  protected:
    std::string asked(const std::string& head, const std::string& body = "") const {
        return http_answer(port_,
                           fmt::format("{} HTTP/1.1\r\nHost: localhost\r\nConnection: "
                                       "close\r\nX-Vantage: 1\r\nContent-Length: {}\r\n\r\n{}",
                                       head, body.size(), body));
    }
    std::string local(const std::string& options) const {
        return fmt::format("http://:{}{}", port_, options);
    }

    const int port_ = two_free_ports().first;
    OperatorInputBox input_;
};

TEST_F(WebServerTest, ServesThePageAndObeys) {
    WebServer server(local("?control=yes"), input_);
    server.show({.picture = ColourImage(72, 96), .set = {}, .state = R"({"a":1})"});
    EXPECT_TRUE(asked("GET /").starts_with("HTTP/1.1 200"));
    EXPECT_TRUE(asked("GET /state").ends_with(R"({"a":1})"));
    EXPECT_NE(asked("GET /programme.jpg").find("image/jpeg"), std::string::npos);
    EXPECT_TRUE(asked("GET /rig.jpg?rig=%3Cb%3E").starts_with("HTTP/1.1 404"));
    EXPECT_TRUE(asked("POST /command", "shot 2").starts_with("HTTP/1.1 204"));
    EXPECT_EQ(input_.take().input.commands.size(), 1u);
    EXPECT_EQ(server.stats().commands, 1u);
}

TEST_F(WebServerTest, SurvivesHostileRequests) {
    WebServer server(local("?control=yes"), input_);
    const std::string large(100'000, 'A');
    // Requests that never end; the caller leaves.
    for (const std::string& request :
         {std::string("\r\n\r\n"), std::string(1000, '\0'), large,
          std::string("GET / HTTP/1.1\r\nHost: "), "GET / HTTP/1.1\r\nHost: " + large,
          std::string("POST /command HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999\r\n"
                      "\r\nlive"),
          "POST /command HTTP/1.1\r\nHost: localhost\r\nX-Vantage: 1\r\nContent-Length: 100000\r\n"
          "\r\n" +
              large}) {
        const LocalCaller caller(port_);
        caller.say(request);
    }
    const std::string escape =
        http_answer(port_,
                    "GET /../../etc/passwd HTTP/1.1\r\nHost: localhost\r\nConnection: "
                    "close\r\n\r\n");
    EXPECT_TRUE(escape.starts_with("HTTP/1.1 404")) << escape;
    EXPECT_TRUE(asked("POST /command", large).find("HTTP/1.1 2") == std::string::npos);
    EXPECT_TRUE(asked("GET /state").starts_with("HTTP/1.1 200")) << "and it still answers";
    EXPECT_TRUE(input_.take().input.commands.empty());
}

TEST_F(WebServerTest, ServesManyClientsAtATime) {
    WebServer server(local(""), input_);
    server.show({.picture = ColourImage(72, 96), .set = {}, .state = "{}"});
    std::atomic<int> served = 0;
    std::vector<std::thread> clients;
    for (int i = 0; i < 50; ++i)
        clients.emplace_back([&] {
            if (asked("GET /programme.jpg").starts_with("HTTP/1.1 200")) ++served;
        });
    for (std::thread& client : clients) client.join();
    EXPECT_EQ(served, 50);
}

TEST_F(WebServerTest, MakesItsOwnCertificate) {
    const TemporaryFolder folder;
    const WebCertificate made = own_certificate(folder.path());
    EXPECT_EQ(made.fingerprint.size(), 95u);
    EXPECT_EQ(own_certificate(folder.path()).certificate, made.certificate) << "and keeps it";
    const auto permissions = std::filesystem::status(folder.path() / "web.key").permissions();
    EXPECT_EQ(permissions & std::filesystem::perms::mask,
              std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
    WebServer server(
        fmt::format("https://:{}?pin=4711&certificate={}&key={}", port_,
                    (folder.path() / "web.crt").string(), (folder.path() / "web.key").string()),
        input_);
    if (!std::filesystem::exists("/usr/bin/openssl")) GTEST_SKIP() << "SKIPPED: no openssl";
    const ProgramResult shown = run_to_end(
        "/bin/sh", {"-c", fmt::format("printf 'GET /state HTTP/1.1\\r\\nHost: localhost\\r\\n"
                                      "Connection: close\\r\\n\\r\\n' | openssl s_client -quiet "
                                      "-CAfile {} -verify_return_error -connect 127.0.0.1:{}",
                                      (folder.path() / "web.crt").string(), port_)});
    EXPECT_NE(shown.out.find("HTTP/1.1 401"), std::string::npos) << shown.out << shown.err;
}

TEST_F(WebServerTest, UrlsAreChecked) {
    const auto refused = [](const std::string& url, const std::string& words) {
        const std::string sentence = thrown_sentence([&] { require_web_url(url); });
        EXPECT_NE(sentence.find(words), std::string::npos) << url << ": " << sentence;
    };
    EXPECT_EQ(thrown_sentence([] { require_web_url("http://:8080?control=yes&pin=1234"); }), "");
    EXPECT_EQ(thrown_sentence([] { require_web_url("https://0.0.0.0:8443?open=yes"); }), "");
    refused("ftp://:8080", "is not http://HOST:PORT");
    refused("https://0.0.0.0:8443", "say open=yes");
    refused("http://0.0.0.0:8443?open=yes", "not encrypted: say https://");
    refused("http://:8080?control=perhaps", "control");
    refused("https://:8080?certificate=a", "both certificate=FILE and key=FILE");
    refused("http://:8080?certificate=a&key=b", "only https:// uses");
    refused("http://:8080?board=none.toml", "none.toml");
    refused("http://:8080?lamps=1", "no option 'lamps'");
    EXPECT_NE(thrown_sentence([&] {
                  WebServer(local("?pin=12"), input_);
              }).find("PIN of the page has 2 characters"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([&] {
                  WebServer(fmt::format("https://:{}?certificate=/nowhere&key=/nowhere", port_),
                            input_);
              }).find("/nowhere"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage
