#pragma once

#include <iterator>
#include <random>
#include <string>

namespace drogue::testing {

/// `text` after one to four random changes, reproducible by `seed`.
inline std::string damaged(std::string text, unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  const auto byte = [&] { return static_cast<char>(random() & 0xffU); };
  const std::string printable = " \n\t\"'[]{}=.,#+-0123456789eE_abcxyz^*/()<>&|?:";
  const std::string numbers[] = {"0", "-1", "9999999999", "1e308", "1e-320", "nan", "inf", "0x7f", "7"};
  for (std::size_t accidents = 1 + below(4); accidents > 0; --accidents) {
    if (text.empty()) text = "a";
    const std::size_t place = below(text.size());
    switch (below(8)) {
      case 0:
        text[place] = byte();
        break;
      case 1:
        text[place] = printable[below(printable.size())];
        break;
      case 2:
        text[place] = static_cast<char>(text[place] ^ (1 << below(8)));
        break;
      case 3:
        text.insert(place, std::string(1 + below(4), byte()));
        break;
      case 4:
        text.erase(place, 1 + below(8));
        break;
      case 5:
        text.resize(place);
        break;
      case 6: {
        const std::string piece = text.substr(place, 1 + below(40));
        for (std::size_t times = 1 + below(20); times > 0; --times) text.insert(place, piece);
        break;
      }
      default:
        if (const std::size_t digit = text.find_first_of("0123456789", place); digit != std::string::npos)
          text.replace(digit, 1, numbers[below(std::size(numbers))]);
    }
  }
  return text;
}

}  // namespace drogue::testing
