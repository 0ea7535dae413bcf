#pragma once
// What a 64-bit ELF file says about itself: enough of the format for two tests.
#include <elf.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

class ElfFile {
 public:
  explicit ElfFile(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(file), {});
    if (bytes_.size() < sizeof(Elf64_Ehdr) || bytes_.compare(0, 4, ELFMAG) != 0) {
      ADD_FAILURE() << path << " is no ELF file";
      return;
    }
    const auto header = at<Elf64_Ehdr>(0);
    for (int i = 0; i < header.e_shnum; ++i)
      sections_.push_back(at<Elf64_Shdr>(header.e_shoff + sizeof(Elf64_Shdr) * size_t(i)));
  }

  std::vector<std::string> needed() const { return dynamic_strings(DT_NEEDED); }
  std::vector<std::string> soname() const { return dynamic_strings(DT_SONAME); }
  std::vector<std::string> run_path() const {
    std::vector<std::string> paths = dynamic_strings(DT_RUNPATH);
    for (const std::string& path : dynamic_strings(DT_RPATH)) paths.push_back(path);
    return paths;
  }

  // Names of the symbols that others may bind to.
  std::vector<std::string> exports() const {
    std::vector<std::string> names;
    for (const Elf64_Shdr& section : sections_) {
      if (section.sh_type != SHT_DYNSYM) continue;
      for (size_t i = 0; i < section.sh_size / sizeof(Elf64_Sym); ++i) {
        const auto symbol = at<Elf64_Sym>(section.sh_offset + i * sizeof(Elf64_Sym));
        if (symbol.st_shndx != SHN_UNDEF && ELF64_ST_BIND(symbol.st_info) != STB_LOCAL)
          names.push_back(string(section.sh_link, symbol.st_name));
      }
    }
    return names;
  }

 private:
  template <class T>
  T at(size_t offset) const {
    T value;
    std::memcpy(&value, bytes_.data() + offset, sizeof value);
    return value;
  }
  std::string string(size_t section, size_t offset) const {
    return bytes_.data() + sections_[section].sh_offset + offset;
  }
  std::vector<std::string> dynamic_strings(Elf64_Sxword tag) const {
    std::vector<std::string> found;
    for (const Elf64_Shdr& section : sections_) {
      if (section.sh_type != SHT_DYNAMIC) continue;
      for (size_t i = 0; i < section.sh_size / sizeof(Elf64_Dyn); ++i) {
        const auto entry = at<Elf64_Dyn>(section.sh_offset + i * sizeof(Elf64_Dyn));
        if (entry.d_tag == tag) found.push_back(string(section.sh_link, entry.d_un.d_val));
      }
    }
    return found;
  }

  std::string bytes_;
  std::vector<Elf64_Shdr> sections_;
};
