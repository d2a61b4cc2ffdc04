#include "host_app/metrics/metrics_server.h"

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/free_ports.h"
#include "tests/support/http_answer.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

class MetricsServerTest : public testing::Test {
  protected:
    std::string answer_to(const std::string& request) const { return http_answer(port_, request); }
    std::string answer_of(const std::string& method, const std::string& path) const {
        return http_answer(port_, method, path);
    }

    const int port_ = two_free_ports().first;
    MetricsServer server_{fmt::format("http://:{}", port_)};
};

TEST_F(MetricsServerTest, ServesTheLastText) {
    server_.show("vantage_ticks_total 7\n# EOF\n");
    const std::string answer = answer_of("GET", "/metrics");
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 200")) << answer;
    EXPECT_NE(answer.find("application/openmetrics-text; version=1.0.0"), std::string::npos);
    EXPECT_TRUE(answer.ends_with("\r\n\r\nvantage_ticks_total 7\n# EOF\n")) << answer;
}

TEST_F(MetricsServerTest, AnswersInTheFormatThatIsAccepted) {
    server_.show(
        "# TYPE vantage_ticks counter\n# HELP vantage_ticks Ticks.\nvantage_ticks_total 7\n# "
        "EOF\n");
    const auto accepting = [&](const std::string& types) {
        return answer_to("GET /metrics HTTP/1.1\r\nHost: a\r\nConnection: close\r\nAccept: " +
                         types + "\r\n\r\n");
    };
    const std::string plain = accepting("text/plain");
    EXPECT_NE(plain.find("text/plain; version=0.0.4"), std::string::npos) << plain;
    EXPECT_TRUE(
        plain.ends_with("\r\n\r\n# TYPE vantage_ticks_total counter\n# HELP "
                        "vantage_ticks_total Ticks.\nvantage_ticks_total 7\n"))
        << plain;
    for (const char* types :
         {"application/openmetrics-text;version=1.0.0,text/plain;version=0.0.4;q=0.5,*/*;q=0.1",
          "*/*"})
        EXPECT_NE(accepting(types).find("application/openmetrics-text"), std::string::npos)
            << types;
    EXPECT_NE(accepting("application/openmetrics-text;q=0.2, text/plain;q=0.9").find("0.0.4"),
              std::string::npos);
}

TEST_F(MetricsServerTest, ServesNoOtherPath) {
    EXPECT_TRUE(answer_of("GET", "/").starts_with("HTTP/1.1 404"));
    EXPECT_TRUE(answer_of("GET", "/metrics/../../etc/passwd").starts_with("HTTP/1.1 404"));
    EXPECT_TRUE(answer_of("DELETE", "/metrics").starts_with("HTTP/1.1 405"));
    EXPECT_FALSE(answer_to("rubbish\r\n\r\n").starts_with("HTTP/1.1 200"));
    EXPECT_TRUE(answer_of("GET", "/metrics").starts_with("HTTP/1.1 200")) << "it goes on";
}

TEST_F(MetricsServerTest, ListensOnLoopbackUnlessOpen) {
    const auto refusal = [](const std::string& url) {
        return thrown_sentence([&] { const MetricsServer server(url); });
    };
    EXPECT_NE(refusal("http://0.0.0.0:9464").find("open=yes"), std::string::npos);
    EXPECT_NE(refusal("udp://:9464").find("http://HOST:PORT"), std::string::npos);
    EXPECT_NE(refusal("http://:9464?opn=yes").find("open"), std::string::npos);
    EXPECT_NE(refusal(fmt::format("http://:{}", port_)).find("choose another"), std::string::npos);
}

}  // namespace
}  // namespace vantage
