#include "common/calibration_forms/text_tree.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

TEST(YamlTree, ReadsMapsListsAndMatricesOfOpenCv) {
    const Tree tree = parse_yaml_tree(R"(%YAML:1.0
---
# a comment
M1: !!opencv-matrix
   rows: 2
   cols: 2
   dt: d
   data: [ 1., 2.5e-01, # half way
       -3, .5 ]
name: "narrow: stereo"   # and another
'quoted': it's here
D:[1, 2]
empty:
last: -1.7e-05
)");
    EXPECT_EQ(tree["M1"]["rows"], 2.0);
    EXPECT_EQ(tree["M1"]["data"], (Tree{1.0, 0.25, -3.0, 0.5}));
    EXPECT_EQ(tree["name"], "narrow: stereo");
    EXPECT_EQ(tree["D"], (Tree{1.0, 2.0}));
    EXPECT_TRUE(tree["empty"].is_null());
    EXPECT_EQ(tree["last"], -1.7e-05);
}

TEST(YamlTree, ReadsListsInEveryStyle) {
    const Tree rows{{1.0, 2.0}, {3.0, 4.0}};
    for (const char* text : {"T:\n  - [1, 2]\n  - [3, 4]\n", "T:\n- [1, 2]\n- [3, 4]\n",
                             "T:\n- - 1\n  - 2\n- - 3.0\n  - 4\n", "T: [[1,2],\r\n [3,4]]\r\n",
                             "T:\n  -\n    - 1\n    - 2\n  -\n    - 3\n    - 4\n"})
        EXPECT_EQ(parse_yaml_tree(text)["T"], rows) << text;
    const Tree maps =
        parse_yaml_tree("cams:\n  - name: a\n    f: 1\n  - name: b\n    f: 2\nend: 1\n");
    EXPECT_EQ(maps["cams"][1]["name"], "b");
    EXPECT_EQ(maps["cams"][1]["f"], 2.0);
    EXPECT_EQ(maps["end"], 1.0);
    EXPECT_EQ(parse_yaml_tree("a: {b: 1, c: [2, 3]}\n")["a"]["c"][1], 3.0);
}

TEST(YamlTree, RefusesDamageWithItsLine) {
    EXPECT_NE(thrown_sentence([] { parse_yaml_tree("a: 1\nb: [1, 2\n"); }).find("line 2"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([] { parse_yaml_tree("a: 1\nnothing\n"); }).find("line 2"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([] { parse_yaml_tree(""); }), "");
    EXPECT_NE(thrown_sentence([] { parse_yaml_tree("a: " + std::string(5000, '[')); }), "");
    std::string deep;
    for (int i = 0; i < 2000; ++i) deep += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
    EXPECT_NE(thrown_sentence([&] { parse_yaml_tree(deep); }).find("too deep"), std::string::npos);
}

TEST(XmlTree, ReadsWhatOpenCvWrites) {
    const Tree tree = parse_xml_tree(R"(<?xml version="1.0"?>
<!-- a comment -->
<opencv_storage>
<M1 type_id="opencv-matrix">
  <rows>3</rows>
  <cols>1</cols>
  <dt>d</dt>
  <data>
    1. -2.5000000000000000e-01
    3.</data></M1>
<names>
  <_>left</_>
  <_>right</_></names>
<one>4</one>
</opencv_storage>
)");
    const Tree& root = tree["opencv_storage"];
    EXPECT_EQ(root["M1"]["data"], (Tree{1.0, -0.25, 3.0}));
    EXPECT_EQ(root["names"], (Tree{"left", "right"}));
    EXPECT_EQ(root["one"], 4.0);
    for (const char* damaged : {"<a>", "<a></b>", "<a b></a>", "<a b=c></a>", "<", "<!-- ", "x"})
        EXPECT_NE(thrown_sentence([&] { parse_xml_tree(damaged); }), "") << damaged;
}

TEST(TextTree, ReadsOrRefusesWhateverComes) {
    const std::string whole =
        "%YAML:1.0\n---\nM: !!opencv-matrix\n   data: [ 1., 2., 3. ]\nl:\n- - a: 1\n    b: {c: "
        "'d'}\n";
    const std::string xml = "<?xml version=\"1.0\"?><o><a b=\"c\">1 2</a><_>3</_><!-- x --></o>";
    std::mt19937 random(3);
    for (int i = 0; i < 20000; ++i) {
        std::string bytes = i % 2 ? whole : xml;
        for (int k = static_cast<int>(random() % 4); k >= 0; --k) {
            const std::size_t at = random() % bytes.size();
            if (random() % 4 == 0)
                bytes.erase(at, 1 + random() % 8);
            else
                bytes[at] =
                    static_cast<char>(random() % 2 ? random() : "-:[]{}\"'#<>/= \n"[random() % 15]);
            if (bytes.empty()) bytes = "-";
        }
        (void)thrown_sentence([&] { parse_yaml_tree(bytes); });
        (void)thrown_sentence([&] { parse_xml_tree(bytes); });
    }
}

}  // namespace
}  // namespace vantage
