#pragma once
// What a page must be to be sent alone: it fetches nothing, and its links lead somewhere.
#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <string>

namespace voyager::test {

// Every value of the attribute, as `href` of href="...".
inline std::vector<std::string> values_of(const std::string& page, const std::string& attribute) {
  std::vector<std::string> values;
  const std::string before = attribute + "=\"";
  for (size_t at = page.find(before); at != std::string::npos; at = page.find(before, at)) {
    at += before.size();
    values.push_back(page.substr(at, page.find('"', at) - at));
  }
  return values;
}

inline void expect_whole_by_itself(const std::string& page) {
  // The names of SVG's namespaces look like addresses, and are none.
  const std::string plain =
      std::regex_replace(page, std::regex(" xmlns(:[a-z]+)?=\"http://www\\.w3\\.org/[^\"]*\""), "");
  EXPECT_NE(plain, page) << "a page has plots";
  for (const char* address : {"http://", "https://", "=\"//", "@import", "stylesheet", "<script"})
    EXPECT_EQ(plain.find(address), std::string::npos) << plain.substr(plain.find(address), 80);
  for (const std::string& image : values_of(plain, "src"))
    EXPECT_EQ(image.rfind("data:", 0), 0u) << image.substr(0, 80);
  std::set<std::string> ids;
  for (const std::string& id : values_of(plain, "id")) EXPECT_TRUE(ids.insert(id).second) << id;
  for (const std::string& link : values_of(plain, "href"))
    EXPECT_TRUE(link[0] != '#' || ids.count(link.substr(1)) == 1) << link;
}

}  // namespace voyager::test
