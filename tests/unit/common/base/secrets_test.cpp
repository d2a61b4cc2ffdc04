#include "common/base/files/secrets.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

TEST(Secrets, are_left_out_however_they_are_written) {
    const std::string key = "rq:rM>}U?@Lns47E1%kR.o@n%FcmmsL/@{H8]yf7";
    const std::string phrase = "correct-Horse1";
    for (const std::string& text :
         {"public = \"" + key + "\"", "secret = '" + key + "'", "hosts\n" + key + " gallery\n",
          "the key is " + key + ", it says", "{\"public_key\": \"" + key + "\"}",
          "VANTAGE_LIVE_OPTIONS=--output srt://host:9000?passphrase=" + phrase + "&latency=60",
          "passphrase = \"" + phrase + "\"", "Password: " + phrase,
          "https://me:" + phrase + "@house.tv/x", "--token " + phrase}) {
        const std::string out = without_secrets(text);
        EXPECT_EQ(out.find(key), std::string::npos) << out;
        EXPECT_EQ(out.find(phrase), std::string::npos) << out;
        EXPECT_NE(out.find("[left out]"), std::string::npos) << out;
    }
    EXPECT_EQ(without_secrets("srt://host:9000?passphrase=" + phrase + "&latency=60"),
              "srt://host:9000?passphrase=[left out]&latency=60");
}

TEST(Secrets, are_left_out_whatever_a_key_begins_with) {
    const std::string rest = "*L+KJrD9+M*SIipk(w7Ve!7{15[pJYBV6ifDk7t";
    constexpr std::string_view z85 =
        "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.-:+=^!/*?&<>()[]{}@%$#";
    for (const char first : z85) {
        const std::string key = first + rest;
        EXPECT_EQ(without_secrets("\"key " + key + " is known\""), "\"key [left out] is known\"");
    }
    EXPECT_EQ(without_secrets("of a://b" + rest.substr(4)), "of [left out]");
}

TEST(Secrets, leave_what_helps) {
    for (const std::string text :
         {"key_file = \"/etc/vantage/rig.key\"", "endpoint = \"tcp://north:5600\"",
          "checksum: \"fnv1a64:e28e610a422ca8cc\"", "authorized_hosts = \"hosts.keys\"",
          "commit 8ebf234f51939aa0741881dca7020349945c8b9f",
          "/usr/share/doc/vantage-rig/examples/Boot2/pi5-global-shutter.txt is missing",
          "/usr/lib/x86-64/Vantage-Rigs/Boot2.example is",
          "srt://House2.example.org:9000?latency=120&mode=caller"})
        EXPECT_EQ(without_secrets(text), text);
}

}  // namespace
}  // namespace vantage
