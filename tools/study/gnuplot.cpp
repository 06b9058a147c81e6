#include "gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>

#include "engine/errors.hpp"
#include "engine/output/files.hpp"

namespace mpmfast {

namespace {

constexpr double kDotsPerInch = 96;
// Distinguishable, the first ten also by most people who do not see red and green apart.
constexpr std::array<const char*, 14> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00",
                                               "#56b4e9", "#7a1fa2", "#8c564b", "#444444", "#b8b000",
                                               "#00c4b3", "#ff9aa2", "#8fd14f", "#b59ce6"};

/// Runs a program in a folder, its messages into a file; its exit code, or −errno when it cannot start.
int run_program(const std::vector<std::string>& words, const std::filesystem::path& folder,
                const std::filesystem::path& messages) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   0644);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  pid_t child = 0;
  const int error = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return -error;
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

}  // namespace

std::string gnuplot_text(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + "'";
}

std::string gnuplot_data(const std::string& name, std::span<const double> x, std::span<const double> y) {
  std::string out = fmt::format("${} << EOD\n", name);
  for (std::size_t k = 0; k < x.size(); ++k) out += fmt::format("{:.6g} {:.6g}\n", x[k], y[k]);
  if (x.empty()) out += "NaN NaN\n";  // gnuplot refuses an empty block
  return out + "EOD\n";
}

std::string draw_with_gnuplot(const ChartFiles& files, const std::string& data, const std::string& plot,
                              int width, int height) {
  const std::filesystem::path& folder = files.folder;
  const bool both = files.format.empty();
  const std::string name = both ? files.stem : files.stem + "." + files.format, script = name + ".gp";
  write_aside(
      folder / script,
      fmt::format(
          "# Draws {0}: gnuplot {1}\nset encoding utf8\n{2}"
          "do for [format in '{3}'] {{\n"
          "if (format eq 'png') {{ set terminal pngcairo size {4},{5} noenhanced font 'sans,11' }}\n"
          "if (format eq 'svg') {{ set terminal svg size {4},{5} noenhanced font 'sans,12' background "
          "'white' }}\n"
          "if (format eq 'pdf') {{ set terminal pdfcairo size {6}in,{7}in noenhanced font 'sans,11' }}\n"
          "point = format eq 'svg' ? 0.6 : 1.0\n"
          "set output {8} . format\n{9}\nunset output\n}}\n",
          both ? fmt::format("{0}.png and {0}.svg", name) : name, script, data,
          both ? "png svg" : files.format, width, height, width / kDotsPerInch, height / kDotsPerInch,
          gnuplot_text(files.stem + "."), plot));
  const std::filesystem::path messages = std::filesystem::absolute(folder / (script + ".messages"));
  const int code = run_program({"gnuplot", "./" + script}, folder, messages);
  std::ifstream stream(messages);
  std::string said{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  std::error_code ignored;
  std::filesystem::remove(messages, ignored);
  if (code == 0) return "";
  const std::string path = (folder / script).string();
  if (code == -ENOENT)
    return fmt::format("no picture of {}: gnuplot is not installed (on Debian: apt-get install gnuplot-nox)",
                       path);
  if (code < 0) return fmt::format("no picture of {}: gnuplot cannot start: {}", path, std::strerror(-code));
  while (!said.empty() && said.back() == '\n') said.pop_back();
  return fmt::format("no picture of {}: gnuplot says:\n{}", path, said);
}

std::string chart_colour(std::size_t index) { return kColours[index % kColours.size()]; }

std::string chart_line(std::size_t index) {
  constexpr std::array<const char*, 5> kDashes{"", " dt 4", " dt 3", " dt 5", " dt 2"};
  return fmt::format("lc rgb '{}'{}", chart_colour(index), kDashes[index / kColours.size() % kDashes.size()]);
}

}  // namespace mpmfast
