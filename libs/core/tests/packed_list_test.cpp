#include <gtest/gtest.h>

#include <numeric>
#include <string>

#include <priormap/core/packed_list.hpp>
#include <priormap/core/parallel.hpp>

namespace packed_list_test {

using priormap::ByteReader;
using priormap::ByteWriter;
using priormap::PackedList;

struct Item {
  std::string name;
  std::vector<std::int64_t> numbers;
  bool operator==(const Item&) const = default;
};

void pack(const Item& item, ByteWriter& out) {
  out.put(item.name);
  out.put(std::uint32_t(item.numbers.size()));
  out.put_all(std::span(item.numbers));
}

void unpack(ByteReader& in, Item& item) {
  item.name = in.text();
  item.numbers.resize(in.get<std::uint32_t>());
  in.get_all(std::span(item.numbers));
}

Item item(std::size_t i, std::size_t length) {
  Item made{"item " + std::to_string(i), std::vector<std::int64_t>(length)};
  std::iota(made.numbers.begin(), made.numbers.end(), std::int64_t(i));
  return made;
}

TEST(PackedList, GivesBackWhatWasPutIn) {
  PackedList<Item> list;
  EXPECT_TRUE(list.empty());
  list.push_back(item(0, 0));
  list.push_back(item(1, 3));
  list.put(0, item(7, 2));
  EXPECT_EQ(std::vector<Item>(list.begin(), list.end()), (std::vector{item(7, 2), item(1, 3)}));
}

TEST(PackedList, HoldsMoreThanItsMemoryFromSeveralThreads) {
  constexpr std::size_t count = 40'000, length = 100;   // 32 MB
  PackedList<Item> list(count);
  priormap::parallel_for(count, 4, [&](std::size_t i) {
    list.put(i, item(i, length));
    ASSERT_EQ(list[i], item(i, length));
  });
  list.push_back(item(count, 3'000'000));   // larger than the memory
  list.push_back(item(count + 1, 1));
  for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(list[i], item(i, length));
  EXPECT_EQ(list[count], item(count, 3'000'000));
  EXPECT_EQ(list[count + 1], item(count + 1, 1));
}

}  // namespace packed_list_test
