#include "host_app/output/output_url.h"

#include <fstream>

#include <gtest/gtest.h>

#include "host_app/output/output_target.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

std::string refusal(const std::string& url, const OutputFormat& format = {}) {
    return thrown_sentence([&] { (void)plan_output(url, format); });
}

bool names(const std::string& sentence, const std::string& words) {
    return sentence.find(words) != std::string::npos;
}

TEST(OutputUrl, ReadsSchemesPlacesAndOptions) {
    const OutputUrl srt = OutputUrl::parse("srt://studio:9000?mode=listener&streamid=a%26b%25");
    EXPECT_EQ(srt.scheme, "srt");
    EXPECT_EQ(srt.place, "studio:9000");
    EXPECT_EQ(srt.option("mode"), "listener");
    EXPECT_EQ(srt.option("streamid"), "a&b%");
    EXPECT_EQ(srt.option("latency"), std::nullopt);
    EXPECT_EQ(OutputUrl::parse("v4l2:/dev/video7").place, "/dev/video7");
    EXPECT_EQ(OutputUrl::parse("-").scheme, "pipe");
    EXPECT_EQ(OutputUrl::parse("pipe:3").place, "3");
    EXPECT_EQ(OutputUrl::parse("a folder/film.mkv?segment=60s").scheme, "file");
    EXPECT_EQ(OutputUrl::parse("a folder/film.mkv?segment=60s").place, "a folder/film.mkv");
    EXPECT_EQ(OutputUrl::parse("10:30.mkv").place, "10:30.mkv");
    EXPECT_EQ(OutputUrl::parse("file:flight.mkv").shown, "flight.mkv");
}

TEST(OutputUrl, ShowsNoSecret) {
    const std::string phrase = "open sesame 1";
    const OutputUrl url = OutputUrl::parse("srt://10.0.0.1:9000?passphrase=" + phrase);
    EXPECT_EQ(url.shown, "srt://10.0.0.1:9000?passphrase=***");
    EXPECT_EQ(passphrase_of(url), phrase);
    for (const std::string rest : {"&mode=both", "&latncy=20", "&bitrate=much", "&nothing"}) {
        const std::string sentence = refusal("srt://10.0.0.1:9000?passphrase=" + phrase + rest);
        EXPECT_FALSE(sentence.empty()) << rest;
        EXPECT_FALSE(names(sentence, phrase)) << sentence;
    }
    EXPECT_FALSE(names(plan_output("srt://10.0.0.1:9000?passphrase=" + phrase, {}).name, phrase));
    for (const std::string mistyped : {"Passphrase", "pasphrase", "pass", "passphrase_", "key"}) {
        const std::string sentence =
            refusal("srt://10.0.0.1:9000?" + mistyped + "=open%20sesame%201");
        EXPECT_TRUE(names(sentence, "'" + mistyped + "'")) << sentence;
        EXPECT_FALSE(names(sentence, "sesame")) << sentence;
    }
    EXPECT_TRUE(names(refusal("srt://10.0.0.1:9000?streamid=a%00b"), "%00"));
}

TEST(OutputUrl, TakesThePassphraseFromAFile) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "phrase";
    std::ofstream(file) << "from a file 1\n";
    const std::string option = "passphrase-file=" + file.string();
    EXPECT_EQ(passphrase_of(OutputUrl::parse("srt://0.0.0.0:9000?" + option)), "from a file 1");
    EXPECT_EQ(refusal("srt://0.0.0.0:9000?mode=listener&" + option), "");
    EXPECT_TRUE(names(refusal("srt://a:9000?passphrase=123456789012&" + option), "and a"));
    std::ofstream(file) << "short";
    EXPECT_TRUE(names(refusal("srt://a:9000?" + option), "10 to 79 characters"));
    EXPECT_TRUE(names(refusal("srt://a:9000?passphrase-file=/no/where"), "/no/where"));
}

TEST(OutputUrl, ServesNobodyBeyondThisComputerWithoutAPassphrase) {
    for (const std::string scheme : {"srt", "rist"}) {
        for (const std::string host : {"0.0.0.0", "[::]", "192.168.1.4", "studio"}) {
            const std::string url = scheme + "://" + host + ":9000?mode=listener";
            EXPECT_TRUE(names(refusal(url), "whoever calls")) << url;
            EXPECT_EQ(refusal(url + "&passphrase=open-sesame"), "") << url;
            EXPECT_EQ(refusal(scheme + "://" + host + ":9000"), "") << "it calls";
        }
        for (const std::string host : {"127.0.0.1", "localhost", "[::1]"})
            EXPECT_EQ(refusal(scheme + "://" + host + ":9000?mode=listener"), "") << host;
    }
}

TEST(OutputUrl, RefusesWhatCannotBeWithASentence) {
    const TemporaryFolder folder;
    const std::string here = folder.path().string();
    std::ofstream(folder.path() / "there.mkv") << "a film";
    const std::vector<std::pair<std::string, std::string>> refused = {
        {"", "needs a file or a URL"},
        {"http://a:80", "outputs are"},
        {"srt://studio", "HOST:PORT"},
        {"srt://*:9000", "0.0.0.0"},
        {"srt://studio:99999", "HOST:PORT"},
        {"srt://a:9000?mdoe=caller", "'mode'"},
        {"srt://a:9000?mode", "NAME=VALUE"},
        {"srt://a:9000?mode=both", "caller or listener"},
        {"srt://a:9000?latency=-1", "0 to 8000 ms"},
        {"srt://a:9000?latency=1s", "0 to 8000 ms"},
        {"srt://a:9000?bitrate=6G", "bitrate=6M"},
        {"srt://a:9000?bitrate=nan", "bitrate=6M"},
        {"srt://a:9000?bitrate=1", "bitrate=6M"},
        {"srt://a:9000?passphrase=%zz3456789012", "%25"},
        {"udp://239.0.0.1:5000?ttl=0", "1 to 255"},
        {"v4l2:video7", "/dev/video10"},
        {"pipe:out", "descriptor"},
        {"pipe:1?format=bmp", "y4m"},
        {"-?format", "NAME=VALUE"},
        {here + "/film.avi", ".mkv"},
        {here + "/no/film.mkv", "no"},
        {here + "/there.mkv", "--overwrite"},
        {here + "/film.mkv?segment=60", "segment=60s"},
        {here + "/film.mkv?segment=0s", "segment=60s"},
        {here + "/film.mkv?segment=nanMB", "segment=60s"},
        {here + "/film.mkv?codec=av1", "no option 'codec'"},
    };
    for (const auto& [url, words] : refused)
        EXPECT_TRUE(names(refusal(url), words)) << url << ": " << refusal(url);
    EXPECT_EQ(refusal(here + "/film.mkv?segment=2.5GB&bitrate=800k"), "");
    EXPECT_EQ(refusal(here + "/there.mkv", {.overwrites = true}), "");
    EXPECT_TRUE(names(refusal(here + "/film.mkv", {.width_px = 641, .height_px = 480}), "even"));
}

}  // namespace
}  // namespace vantage
