#include "gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>

#include "engine/errors.hpp"
#include "engine/output/files.hpp"

namespace mpmfast {

namespace {

namespace fs = std::filesystem;

constexpr double kDotsPerInch = 96;
// Distinguishable, the first ten also by most people who do not see red and green apart.
constexpr std::array<const char*, 14> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00",
                                               "#56b4e9", "#7a1fa2", "#8c564b", "#444444", "#b8b000",
                                               "#00c4b3", "#ff9aa2", "#8fd14f", "#b59ce6"};

/// What gnuplot calls the pictures in its own folder: no name of a user's reaches it.
constexpr const char* kPicture = "chart";

/// A folder of its own for gnuplot, which is gone in the end.
class WorkFolder {
 public:
  WorkFolder() {
    std::error_code error;
    fs::path base = fs::temp_directory_path(error);
    if (error) base = "/tmp";
    std::string name = (base / "mpmfast-chart-XXXXXX").string();
    if (!mkdtemp(name.data())) throw_file_error("make the folder", name);
    path_ = name;
  }
  WorkFolder(const WorkFolder&) = delete;
  ~WorkFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Runs a program in a folder, its messages into a file; its exit code, or −errno when it cannot start.
int run_program(const std::vector<std::string>& words, const fs::path& folder, const fs::path& messages) {
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

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::vector<std::string> formats_of(const ChartFiles& files) {
  if (!files.format.empty()) return {files.format};
  return {"png", "svg"};
}

/// What `gnuplot SCRIPT` calls the pictures where a user runs the script: gnuplot takes a name that begins
/// with '|' for a command, so the script holds plain names only.
std::string own_name(const std::string& stem) {
  const auto is_plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.' || c == '=';
  };
  const bool plain = !stem.empty() && std::isalnum(static_cast<unsigned char>(stem[0])) &&
                     std::all_of(stem.begin(), stem.end(), is_plain);
  return plain ? stem : kPicture;
}

std::string script_text(const ChartFiles& files, const std::string& data, const std::string& plot, int width,
                        int height) {
  return fmt::format(
      "# Draws {0} when gnuplot reads it\nset encoding utf8\n"
      "if (!exists('picture')) picture = '{1}'\n{2}"
      "do for [format in '{3}'] {{\n"
      "if (format eq 'png') {{ set terminal pngcairo size {4},{5} noenhanced font 'sans,11' }}\n"
      "if (format eq 'svg') {{ set terminal svg size {4},{5} noenhanced font 'sans,12' background "
      "'white' }}\n"
      "if (format eq 'pdf') {{ set terminal pdfcairo size {6}in,{7}in noenhanced font 'sans,11' }}\n"
      "point = format eq 'svg' ? 0.6 : 1.0\n"
      "set output picture . '.' . format\n{8}\nunset output\n}}\n",
      files.format.empty() ? fmt::format("{0}.png and {0}.svg", own_name(files.stem))
                           : own_name(files.stem) + "." + files.format,
      own_name(files.stem), data, fmt::join(formats_of(files), " "), width, height, width / kDotsPerInch,
      height / kDotsPerInch, plot);
}

}  // namespace

std::string gnuplot_text(const std::string& text) {
  constexpr std::string_view kPlain = " .,:;()+-*/=_<>%&!?[]^~|'";
  std::string out = "\"";
  bool coded = false;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_digit = std::isdigit(byte);
    if (byte < 0x20 || byte == 0x7f) {
      out += ' ';
      coded = false;
    } else if ((byte >= 0x80 || std::isalnum(byte) || kPlain.find(c) != kPlain.npos) &&
               !(coded && is_digit)) {
      out += c;
      coded = false;
    } else {  // a digit behind a code would be read as part of it
      out += fmt::format("\\{:03o}", byte);
      coded = true;
    }
  }
  return out + '"';
}

std::string gnuplot_tic(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '%' ? "%%" : std::string(1, c);
  return gnuplot_text(out);
}

std::string gnuplot_data(const std::string& name, std::span<const double> x, std::span<const double> y) {
  std::string out = fmt::format("${} << EOD\n", name);
  for (std::size_t k = 0; k < x.size(); ++k) out += fmt::format("{:.6g} {:.6g}\n", x[k], y[k]);
  if (x.empty()) out += "NaN NaN\n";  // gnuplot refuses an empty block
  return out + "EOD\n";
}

std::string draw_with_gnuplot(const ChartFiles& files, const std::string& data, const std::string& plot,
                              int width, int height) {
  const std::string name = files.format.empty() ? files.stem : files.stem + "." + files.format;
  const fs::path script = files.folder / (name + ".gp");
  write_aside(script, script_text(files, data, plot, width, height));
  const WorkFolder work;
  const fs::path messages = work.path() / "messages";
  // The path of a script begins with '/': one that begins with '<' would be a command.
  const int code = run_program({"gnuplot", "-e", fmt::format("picture='{}'", kPicture), fs::absolute(script)},
                               work.path(), messages);
  if (code == -ENOENT)
    return fmt::format("no picture of {}: gnuplot is not installed (on Debian: apt-get install gnuplot-nox)",
                       script.string());
  if (code < 0)
    return fmt::format("no picture of {}: gnuplot cannot start: {}", script.string(), std::strerror(-code));
  std::string said = content_of(messages);
  while (!said.empty() && said.back() == '\n') said.pop_back();
  if (code != 0) return fmt::format("no picture of {}: gnuplot says:\n{}", script.string(), said);
  for (const std::string& format : formats_of(files)) {
    const std::string drawn = content_of(work.path() / fmt::format("{}.{}", kPicture, format));
    if (drawn.empty())
      return fmt::format("no picture of {}: gnuplot drew nothing{}{}", script.string(),
                         said.empty() ? "" : ", and says:\n", said);
    write_aside(files.folder / fmt::format("{}.{}", files.stem, format), drawn);
  }
  return "";
}

std::string chart_colour(std::size_t index) { return kColours[index % kColours.size()]; }

std::string chart_line(std::size_t index) {
  constexpr std::array<const char*, 5> kDashes{"", " dt 4", " dt 3", " dt 5", " dt 2"};
  return fmt::format("lc rgb '{}'{}", chart_colour(index), kDashes[index / kColours.size() % kDashes.size()]);
}

}  // namespace mpmfast
