#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <random>

#include "common/csv/fields.hpp"
#include "common/csv/header.hpp"
#include "common/csv/line_reader.hpp"
#include "common/csv/numbers.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_file.hpp"

namespace drogue::csv {
namespace {

std::vector<std::string> split_line(const std::string& line) {
  Fields fields;
  EXPECT_EQ(fields.split(line), "") << line;
  std::vector<std::string> values;
  for (std::size_t i = 0; i < fields.size(); ++i) values.emplace_back(fields[i]);
  return values;
}

struct CsvFile : testing::TemporaryFile {
  explicit CsvFile(const std::string& content) : TemporaryFile(content, "test.csv") {}
};

TEST(CsvFields, SplitsALine) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(split_line("a, b ,,\tc"), (Words{"a", "b", "", "c"}));
  EXPECT_EQ(split_line(""), Words{""});
  EXPECT_EQ(split_line(","), (Words{"", ""}));
  EXPECT_EQ(split_line(R"("a,b", "say ""no""" ,"",x)"), (Words{"a,b", "say \"no\"", "", "x"}));
  EXPECT_EQ(split_line(R"("",)"), (Words{"", ""}));
}

/// The parser examines eight characters at a time.
TEST(CsvFields, SplitsLinesOfAnyLength) {
  std::mt19937 random(5);
  const char* const letters[] = {"a", "b", ".", "-", "+", "\xC2\xAC", "\x7f", "\xE2\xAC\xBF", ",", ","};
  for (int trial = 0; trial < 2000; ++trial) {
    std::string line;
    std::vector<std::string> values(1);
    for (auto k = random() % 40; k > 0; --k) {
      const std::string letter = letters[random() % 10];
      line += letter;
      if (letter == ",") {
        values.emplace_back();
      } else {
        values.back() += letter;
      }
    }
    EXPECT_EQ(split_line(line), values) << line;
  }
}

TEST(CsvFields, ReportsTheFault) {
  Fields fields;
  EXPECT_NE(fields.split("\"a"), "");
  EXPECT_NE(fields.split("\"a\"b"), "");
  EXPECT_NE(fields.split("a\"b"), "");
  EXPECT_NE(fields.split("a,\"b\"\""), "");
}

TEST(CsvFields, ShownTextIsShortAndOnOneLine) {
  EXPECT_EQ(shown("a b"), "\"a b\"");
  EXPECT_EQ(shown(std::string_view("a\n\0\x7f", 4)), "\"a???\"");
  std::string cut(1, '"');
  cut.append(40, 'x').append("...\"");
  EXPECT_EQ(shown(std::string(41, 'x')), cut);
}

TEST(CsvFields, KeepsTheFieldsBeforeAFault) {
  Fields fields;
  for (const char* line : {R"(a,"b ""c""",d"e,f)", R"(a,"b ""c""","d,e)", R"(a,"b ""c""","d"e)"}) {
    EXPECT_NE(fields.split(line), "");
    ASSERT_EQ(fields.size(), 2U) << line;
    EXPECT_EQ(fields[0], "a");
    EXPECT_EQ(fields[1], "b \"c\"");
  }
}

TEST(CsvFields, WrittenTextReadsBackEqual) {
  std::mt19937 random(1);
  const std::string letters = "ab ,\"\t'";
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<std::string> values(1 + random() % 4);
    std::string line;
    for (std::string& value : values) {
      for (auto k = random() % 6; k > 0; --k) value += letters[random() % letters.size()];
      if (&value != values.data()) line += ',';
      append_field(line, value);
    }
    EXPECT_EQ(split_line(line), values) << line;
  }
}

TEST(CsvNumbers, ReadsDecimalsOnly) {
  double value = 0.0;
  EXPECT_EQ(parse_number("+1.5e-3", value), NumberError::none);
  EXPECT_EQ(value, 1.5e-3);
  for (const char* text : {"", "+", "-", "1 ", " 1", "0x1p3", "1,5", "+-1", "++1", "1e", "one"})
    EXPECT_EQ(parse_number(text, value), NumberError::no_number) << text;
  for (const char* text : {"nan", "inf", "-inf", "INFINITY", "1e309", "-1e400"})
    EXPECT_EQ(parse_number(text, value), NumberError::not_finite) << text;
  EXPECT_EQ(parse_number("1e-400", value), NumberError::none);
  EXPECT_EQ(value, 0.0);
  EXPECT_EQ(parse_number("5e-324", value), NumberError::none);
  EXPECT_EQ(value, std::numeric_limits<double>::denorm_min());
}

/// The fast path for short numbers must agree with the standard library bit for bit.
TEST(CsvNumbers, AgreesWithTheStandardLibrary) {
  std::mt19937 random(6);
  const std::string letters = "0123456789.";
  int with_value = 0;
  for (int trial = 0; trial < 200000; ++trial) {
    std::string text(random() % 3 == 0 ? "-" : "");
    bool has_point = false;
    for (auto k = random() % 18; k > 0; --k) {
      text += letters[random() % (has_point ? 10 : 11)];
      has_point = has_point || text.back() == '.';
    }
    double expected = 0.0, value = 0.0;
    const char* const end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, expected);
    const bool is_number = stopped == end && error == std::errc{};
    ASSERT_EQ(parse_number(text, value) == NumberError::none, is_number) << text;
    if (!is_number) continue;
    ++with_value;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(expected)) << text;
  }
  EXPECT_GT(with_value, 100000);
}

TEST(CsvNumbers, WrittenTextReadsBackEqual) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 1000; ++trial) {
    const double value = std::ldexp(static_cast<double>(random()), static_cast<int>(random() % 2000) - 1060);
    std::string text;
    append_number(text, value);
    double again = 0.0;
    ASSERT_EQ(parse_number(text, again), NumberError::none) << text;
    EXPECT_EQ(again, value);
  }
  std::string nothing;
  append_number(nothing, std::nan(""));
  EXPECT_EQ(nothing, "");
}

TEST(CsvLines, CountsLinesAndStripsTheirEnds) {
  const CsvFile file(
      "\xEF\xBB\xBF"
      "first\r\n\n  \nfourth\n\r\nlast");
  LineReader reader(file.path());
  Line line;
  std::vector<std::pair<std::string, std::int64_t>> seen;
  while (reader.next(line)) seen.emplace_back(line.text, line.number);
  using Seen = decltype(seen);
  EXPECT_EQ(seen, (Seen{{"first", 1}, {"fourth", 4}, {"last", 6}}));
  EXPECT_EQ(reader.share(), 1.0);
}

TEST(CsvLines, ShareEndsAtTheLastLineReturned) {
  const CsvFile file("one\ntwo\nsix\nten\n");
  LineReader reader(file.path());
  Line line;
  EXPECT_EQ(reader.share(), 0.0);
  for (const double share : {0.25, 0.5, 0.75, 1.0}) {
    ASSERT_TRUE(reader.next(line));
    EXPECT_EQ(reader.share(), share) << line.text;
  }
}

/// Lines that end at and near the ends of the read blocks.
TEST(CsvLines, ReadsLinesAcrossBufferBlocks) {
  std::string content;
  std::vector<std::string> lines;
  std::mt19937 random(3);
  while (content.size() < (std::size_t{5} << 20)) {
    lines.push_back("x" + std::string(random() % 65000, static_cast<char>('a' + random() % 26)));
    content += lines.back() + (random() % 2 == 0 ? "\n" : "\r\n");
  }
  const CsvFile file(content);
  LineReader reader(file.path());
  Line line;
  for (const std::string& expected : lines) {
    ASSERT_TRUE(reader.next(line));
    ASSERT_TRUE(line.text == expected) << line.number;
    EXPECT_FALSE(line.too_long);
  }
  EXPECT_FALSE(reader.next(line));
}

TEST(CsvLines, MarksOverlongLines) {
  for (const std::size_t length : {LineReader::longest, LineReader::longest + 1, std::size_t{3} << 20})
    for (const char* end : {"", "\n", "\nnext"}) {
      const CsvFile file("before\n" + std::string(length, 'x') + end);
      LineReader reader(file.path());
      Line line;
      ASSERT_TRUE(reader.next(line));
      EXPECT_EQ(line.text, "before");
      ASSERT_TRUE(reader.next(line));
      EXPECT_EQ(line.too_long, length > LineReader::longest);
      EXPECT_EQ(reader.next(line), std::string(end) == "\nnext");
      if (std::string(end) == "\nnext") {
        EXPECT_EQ(line.text, "next");
      }
    }
}

TEST(CsvHeader, FindsColumns) {
  const CsvFile file("\n c ,a\n1,2\n");
  LineReader reader(file.path());
  const Header header = read_header(reader, {"a", "b", "c"});
  EXPECT_EQ(header.line, 2);
  EXPECT_EQ(header.places, (std::vector<int>{1, -1, 0}));
}

/// Message of the failure that reading the header of `content` ends in.
std::string header_fault(const std::string& content) {
  const CsvFile file(content);
  LineReader reader(file.path());
  const std::string message = testing::refusal_of([&] { return read_header(reader, {"first", "second"}); });
  return message.substr(message.find(".csv:") + 5);
}

TEST(CsvHeader, NamesTheSeparatorAndTheEncoding) {
  EXPECT_NE(header_fault("first;second\n1;2\n")
                .find("1: unknown column \"first;second\": the separator is a semicolon"),
            std::string::npos);
  EXPECT_NE(header_fault("first\tsecond\n").find("the separator is a tab"), std::string::npos);
  EXPECT_NE(header_fault("first|second\n").find("the separator is a vertical line"), std::string::npos);
  EXPECT_NE(header_fault("sep=;\nfirst;second\n").find("1: the separator is a semicolon"), std::string::npos);
  EXPECT_NE(header_fault("first,second,,\n").find("a separator, the comma"), std::string::npos);
  const std::string little("f\0i\0r\0\n\0", 8), big("\0f\0i\0r\0\n", 8);
  for (const std::string& text : {"\xFF\xFE" + little, "\xFE\xFF" + big, little, big})
    EXPECT_EQ(header_fault(text), "1: the encoding is UTF-16; save the file as UTF-8");
  const std::string wide_little("f\0\0\0i\0\0\0\n\0\0\0", 12), wide_big("\0\0\0f\0\0\0i\0\0\0\n", 12);
  const std::string mark_little("\xFF\xFE\0\0", 4), mark_big("\0\0\xFE\xFF", 4);
  for (const std::string& text : {mark_little + wide_little, mark_big + wide_big, wide_little, wide_big})
    EXPECT_EQ(header_fault(text), "1: the encoding is UTF-32; save the file as UTF-8");
  EXPECT_EQ(header_fault("first,pr\xE9nom\n"),
            "1: the header cannot be read: the line is not UTF-8; save the file as UTF-8");
  EXPECT_NE(header_fault("\"sep=;\"\nfirst;second\n").find("1: the separator is a semicolon"),
            std::string::npos);
  const std::string old_mac = "first,second\r1,2\r";
  EXPECT_EQ(header_fault(old_mac), "1: the lines end in CR alone; LF or CRLF must end them");
  std::string large;
  while (large.size() <= LineReader::longest) large += old_mac;
  EXPECT_EQ(header_fault(large), "1: the lines end in CR alone; LF or CRLF must end them");
  EXPECT_NE(header_fault("sep=,\n").find("the file is empty"), std::string::npos);
}

TEST(CsvHeader, SkipsTheSeparatorOfSpreadsheetsAndRowsOfCommas) {
  const CsvFile file(
      "\"sep=,\"\na,b,c\n,,\n1,2,3\n, ,,,\n,\n, , ,\n\"\",\"\",\"\"\n\"\", \" \"\n\"\"\n\"\"\"\",\n");
  LineReader reader(file.path());
  EXPECT_EQ(read_header(reader, {"a", "b", "c"}).line, 2);
  Line line;
  ASSERT_TRUE(reader.next(line));
  EXPECT_EQ(line.text, "1,2,3");
  ASSERT_TRUE(reader.next(line));
  EXPECT_EQ(line.text, "\"\"\"\",");  // a field that is a quote
  EXPECT_FALSE(reader.next(line));
}

TEST(CsvFields, RefusesLinesThatAreNotUtf8) {
  Fields fields;
  for (const char* line : {"\xC3\xA9,1", "\xE2\x82\xAC", "\xF0\x9F\x98\x80,\"a\"", "\xED\x9F\xBF"})
    EXPECT_EQ(fields.split(line), "") << line;
  for (const char* line : {"\xE9,1", "1,abcdefgh\xE9", "\"\xE9\",1", "\xC3", "\xC0\x80", "\xE0\x80\x80",
                           "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\x80", "\xE2\x82,"}) {
    EXPECT_EQ(fields.split(line), "the line is not UTF-8; save the file as UTF-8") << line;
    EXPECT_EQ(fields.size(), 0U);
  }
  const std::string letters(39, 'a');
  EXPECT_EQ(shown(letters + "\xC3\xA9" + "b"), "\"" + letters + "...\"");
}

TEST(CsvFields, DropsTrailingEmptyFields) {
  Fields fields;
  EXPECT_EQ(fields.split("a,,,"), "");
  fields.drop_trailing_empty(2);
  EXPECT_EQ(fields.size(), 2U);
  fields.drop_trailing_empty(0);
  EXPECT_EQ(fields.size(), 1U);
}

}  // namespace
}  // namespace drogue::csv
