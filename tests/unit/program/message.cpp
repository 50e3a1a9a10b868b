#include "common/program/message.hpp"

#include <gtest/gtest.h>

namespace drogue {
namespace {

TEST(Message, ReadsBackWrittenValues) {
  MessageWriter writer;
  writer.put(7);
  writer.put_text(std::string_view("a\0b", 3));
  writer.put_all(std::vector<double>{0.5, -1.5});
  writer.put_all(std::vector<int>());
  writer.put(true);
  const std::string bytes = writer.take();
  MessageReader reader(bytes);
  EXPECT_EQ(reader.get<int>(), 7);
  EXPECT_EQ(reader.get_text(), std::string_view("a\0b", 3));
  EXPECT_EQ(reader.get_all<double>(), (std::vector<double>{0.5, -1.5}));
  EXPECT_TRUE(reader.get_all<int>().empty());
  EXPECT_TRUE(reader.get<bool>());
  EXPECT_THROW((void)reader.get<char>(), std::out_of_range);
}

TEST(Message, ThrowsOnATruncatedMessage) {
  MessageWriter writer;
  writer.put_text("twelve bytes");
  const std::string bytes = writer.take();
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const std::string part = bytes.substr(0, length);
    MessageReader reader(part);
    EXPECT_THROW((void)reader.get_text(), std::out_of_range) << length;
  }
}

}  // namespace
}  // namespace drogue
