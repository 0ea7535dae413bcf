#include "tests/fuzz/json_mutation.h"

#include <iterator>
#include <string>
#include <vector>

namespace voyager::fuzz {
namespace {

using Json = nlohmann::json;

void list_values(Json& json, std::vector<Json*>& values) {
  if (json.is_structured())
    for (Json& value : json) list_values(value, values);
  values.push_back(&json);
}

void mutate_text(std::string& text) {
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  Bytes bytes(first, first + text.size());
  mutate(bytes, bytes.size() + 16);
  text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

void mutate_value(Json& value, Random& random) {
  const Json edges[] = {nullptr,
                        true,
                        -1,
                        0,
                        1,
                        2,
                        3,
                        4,
                        0.5,
                        1e300,
                        5120,
                        5121,
                        5123,
                        5126,
                        252,
                        4294967295u,
                        UINT64_MAX,
                        "SCALAR",
                        "VEC3",
                        "VEC4",
                        Json::array(),
                        Json::object(),
                        {0, 1},
                        {0, 0, 0, 1}};
  if (random.once_in(3)) {
    value = edges[random.below(std::size(edges))];
  } else if (value.is_number_integer()) {
    value = value.get<int64_t>() + static_cast<int64_t>(random.below(9)) - 4;
  } else if (value.is_number()) {
    value = value.get<double>() * (static_cast<double>(random.below(9)) - 4);
  } else if (value.is_string()) {
    mutate_text(value.get_ref<std::string&>());
  } else if (value.is_array() && !value.empty()) {
    const size_t at = random.below(value.size());
    if (random.once_in(2))
      value.erase(at);
    else
      value.push_back(Json(value[at]));
  } else if (value.is_object() && !value.empty()) {
    auto field = value.begin();
    std::advance(field, static_cast<std::ptrdiff_t>(random.below(value.size())));
    value.erase(field);
  }
}

// A value comes a second time in the place of another.
void copy_value(const std::vector<Json*>& values, Random& random) {
  const Json copy = *values[random.below(values.size())];
  *values[random.below(values.size())] = copy;
}

}  // namespace

void mutate_json(Json& json, Random& random) {
  for (size_t times = 1 + random.below(3); times > 0; --times) {
    std::vector<Json*> values;
    list_values(json, values);
    if (random.once_in(8))
      copy_value(values, random);
    else
      mutate_value(*values[random.below(values.size())], random);
  }
}

}  // namespace voyager::fuzz
