#include "progress_display.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "complain.hpp"

namespace mpmfast {

namespace {

double share_of(const Progress& progress) {
  return progress.end > 0 ? std::clamp(progress.time / progress.end, 0.0, 1.0) : 0;
}

std::string status_text(const Progress& progress) {
  std::string out = fmt::format("{:3.0f} %  step {}  {} of {}  {}particle-steps/s", 100 * share_of(progress),
                                progress.step, time_text(progress.time), time_text(progress.end),
                                count_text(progress.particle_steps_per_second));
  if (progress.seconds_left > 0) out += fmt::format("  {} left", clock_text(progress.seconds_left));
  return out + fmt::format("  energy {:+.2g} %", 100 * progress.energy_error);
}

std::string bar_text(const Progress& progress) {
  constexpr std::size_t kCells = 20;
  const auto full = static_cast<std::size_t>(share_of(progress) * kCells);
  return "[" + std::string(full, '#') + std::string(kCells - full, '.') + "] " + status_text(progress);
}

/// To the terminal, which obeys it.
void command(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

std::size_t terminal_width() {
  constexpr std::size_t kUsual = 80;
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : kUsual;
}

}  // namespace

std::string time_text(double seconds) {
  struct Scale {
    double unit;
    const char* name;
  };
  for (const Scale& scale : {Scale{1, "s"}, Scale{1e-3, "ms"}, Scale{1e-6, "us"}}) {
    if (std::abs(seconds) >= scale.unit) return fmt::format("{:.4g} {}", seconds / scale.unit, scale.name);
  }
  return seconds == 0 ? "0 s" : fmt::format("{:.4g} ns", seconds * 1e9);
}

std::string clock_text(double seconds) {
  if (!std::isfinite(seconds) || seconds > 1e9) return "?";
  const long whole = std::lround(std::max(seconds, 0.0));
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string count_text(double number) {
  if (number >= 1e9) return fmt::format("{:.2f} G", number / 1e9);
  if (number >= 1e6) return fmt::format("{:.2f} M", number / 1e6);
  if (number >= 1e3) return fmt::format("{:.1f} k", number / 1e3);
  return fmt::format("{:.0f} ", number);
}

ProgressDisplay::ProgressDisplay(ProgressStyle style)
    : silent_(style == ProgressStyle::none),
      bar_(style == ProgressStyle::automatic && isatty(STDERR_FILENO) == 1) {}

void ProgressDisplay::show(const Progress& progress) {
  if (silent_) return;
  if (bar_) return redraw(bar_text(progress));
  const double share = share_of(progress), waited = progress.wall - last_wall_;
  if ((share - last_share_ >= 0.05 && waited >= 2) || waited >= 60) {
    print_line(progress);
    last_wall_ = progress.wall;
    last_share_ = share;
  }
}

void ProgressDisplay::show(const std::string& text, bool news) {
  if (silent_) return;
  if (bar_) return redraw(text);
  if (news) complain("    {}\n", text);
}

void ProgressDisplay::clear() {
  if (drawn_) command("\r\x1b[K");
  drawn_ = false;
}

void ProgressDisplay::redraw(std::string line) {
  line.resize(std::min(line.size(), terminal_width() - 1));  // a wrapped line could not be redrawn
  command("\r" + line + "\x1b[K");
  drawn_ = true;
}

void ProgressDisplay::print_line(const Progress& progress) { complain("{}\n", status_text(progress)); }

void ProgressDisplay::finish() {
  if (drawn_) complain("\n");
  drawn_ = false;
}

}  // namespace mpmfast
