#include "common/take/kept_frame.h"

#include <gtest/gtest.h>

#include "tests/support/thrown_sentence.h"
#include "tests/unit/common/take/small_take.h"

namespace vantage {
namespace {

KeptFrame kept_frame() {
    const TakeFacts facts = small_facts({"north"}, 1000);
    KeptFrame kept{facts.rigs[0], facts.pulse_rate_hz, 37, {}};
    kept.frame = FrameStorer(kept.rig).store(sent_frame("north", 1001));
    kept.frame.record.colour_crc = crc32(kept.frame.colour);
    kept.frame.record.depth_crc = crc32(kept.frame.depth);
    return kept;
}

TEST(KeptFrameTest, RoundTrips) {
    const KeptFrame sent = kept_frame();
    const KeptParts parts = encode(sent);
    EXPECT_EQ(parts.pulse, 1001u);
    const KeptFrame came = decode_kept_frame(parts);
    EXPECT_EQ(came.rig, sent.rig);
    EXPECT_EQ(came.pulse_rate_hz, 25);
    EXPECT_EQ(came.tai_offset_s, 37);
    EXPECT_EQ(came.frame.colour, sent.frame.colour);
    EXPECT_EQ(came.frame.depth, sent.frame.depth);
    EXPECT_EQ(to_text(came.frame.record), to_text(sent.frame.record));
}

TEST(KeptFrameTest, RefusesFramesThatContradictTheirRecord) {
    const auto refuses = [](const auto& change) {
        KeptParts parts = encode(kept_frame());
        change(parts);
        return !thrown_sentence([&] { (void)decode_kept_frame(parts); }).empty();
    };
    const auto set_head = [](KeptParts& parts, const std::string& text) {
        const auto bytes = std::as_bytes(std::span(text));
        parts.head.assign(bytes.begin(), bytes.end());
    };
    EXPECT_FALSE(refuses([](KeptParts&) {}));
    EXPECT_TRUE(refuses([](KeptParts& parts) { parts.colour[20] ^= std::byte{1}; }));
    EXPECT_TRUE(refuses([](KeptParts& parts) { parts.depth.pop_back(); }));
    EXPECT_TRUE(refuses([](KeptParts& parts) { parts.depth.clear(); }));
    EXPECT_TRUE(refuses([](KeptParts& parts) { parts.record[5] ^= std::byte{1}; }));
    EXPECT_TRUE(refuses([](KeptParts& parts) { parts.record.resize(1 << 17); }));
    for (const char* text : {"", "[]", "{}", "{\"rig\": 3}"})
        EXPECT_TRUE(refuses([&](KeptParts& parts) { set_head(parts, text); })) << text;
    const std::string head(reinterpret_cast<const char*>(encode(kept_frame()).head.data()),
                           encode(kept_frame()).head.size());
    for (const auto& [was, is] : {std::pair("\"north\"", "\"south\""),
                                  {"\"codec\":2", "\"codec\":0"},
                                  {"\"codec\":2", "\"codec\":9"},
                                  {":62", ":1e300"},
                                  {":62", ":5000"},
                                  {":25.0", ":0.0"},
                                  {":37", ":1e9"}}) {
        const std::size_t at = head.find(was);
        ASSERT_NE(at, std::string::npos) << was << " in " << head;
        std::string changed = head;
        changed.replace(at, std::string(was).size(), is);
        EXPECT_TRUE(refuses([&](KeptParts& parts) { set_head(parts, changed); })) << changed;
    }
}

}  // namespace
}  // namespace vantage
