// Text of files in messages: nothing that a terminal would act upon.
#include "base/printable.hpp"

#include <gtest/gtest.h>

#include <string>

namespace thalweg {
namespace {

using namespace std::string_literals;

TEST(Printable, KeepsText) {
  EXPECT_EQ(printable(""), "");
  EXPECT_EQ(printable("Höhe 3 €, 𝄞 ~"), "Höhe 3 €, 𝄞 ~");
}

TEST(Printable, IsOneLine) {
  EXPECT_EQ(printable("a\r\nb\tc"), "a  b c");
}

TEST(Printable, SpellsOutControls) {
  EXPECT_EQ(printable("\x1b[2J\x07\x7f\0"s), "\\x1b[2J\\x07\\x7f\\x00");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J\xc2\xa0"),
            "\\xc2\\x9b2J\xc2\xa0");
}

TEST(Printable, SpellsOutWhatIsNoUtf8) {
  EXPECT_EQ(printable("\xff"
                      "a\x80"),
            "\\xffa\\x80");
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");                    // too long
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // a surrogate
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond Unicode
  EXPECT_EQ(printable("\xe2\x82"), "\\xe2\\x82");                    // cut off
}

}  // namespace
}  // namespace thalweg
