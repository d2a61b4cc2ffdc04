#include <fstream>

#include <gmock/gmock.h>
#include <unistd.h>

#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/ports/bench_test.h"

namespace vantage {
namespace {

using testing::HasSubstr;

TEST_F(BenchTest, MidiSaysWhatIsMissing) {
    const TemporaryFolder folder;
    const auto refusal = [&](const std::string& url) {
        return thrown_sentence([&] { (void)open_port(url, bench_); });
    };
    EXPECT_THAT(refusal("midi://all?map=" + (folder.path() / "none.toml").string()),
                HasSubstr("none.toml"));
    if (access("/dev/snd/seq", F_OK) == 0)
        EXPECT_THAT(refusal("midi://all?mpa=x"), HasSubstr("'map'"));
    else
        EXPECT_THAT(refusal("midi://all"), HasSubstr("sudo modprobe snd-seq"));
}

}  // namespace
}  // namespace vantage
