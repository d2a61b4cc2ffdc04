#include <gtest/gtest.h>

#include "host_app/synthesis/synthesiser.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

const SynthesiserOption options[] = {
    {.name = "focal-m", .summary = "", .by_default = "0", .words = {}, .least = 0, .most = 9},
    {.name = "rays", .summary = "", .by_default = "plain", .words = {"plain", "corrected"}}};

TEST(SynthesiserChoices, TakeWhatIsChosenAndElseTheDefaults) {
    const SynthesiserChoices none("slab", "", options);
    EXPECT_EQ(none.number("focal-m"), 0);
    EXPECT_EQ(none.word("rays"), "plain");
    const SynthesiserChoices both("slab", "rays=corrected,focal-m=3.5", options);
    EXPECT_EQ(both.number("focal-m"), 3.5);
    EXPECT_EQ(both.word("rays"), "corrected");
}

TEST(SynthesiserChoices, SayWhatThereIsWhenAskedForOtherThings) {
    const auto refusal = [](const char* text) {
        return thrown_sentence([&] { SynthesiserChoices("slab", text, options); });
    };
    EXPECT_EQ(refusal("aperture-m=1"),
              "the synthesiser slab has no option 'aperture-m'; it has focal-m, rays");
    EXPECT_EQ(refusal("rays=bent"),
              "rays of the synthesiser slab is one of plain, corrected, not 'bent'");
    for (const char* text : {"focal-m=", "focal-m", "focal-m=10", "focal-m=-1", "focal-m=2m"})
        EXPECT_NE(refusal(text).find("focal-m of the synthesiser slab is a number from 0 to 9"),
                  std::string::npos)
            << text;
}

}  // namespace
}  // namespace vantage
