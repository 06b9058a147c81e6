/// @file The main function of the tests of mutants: runs the cases whose names are the lines of the file
/// MUTANT_CASES, and writes of each what it took and which mutants it asked for.

#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <string>

#include "mutation_switch.hpp"

namespace {

int cases_run = 0;

/// As doctest takes it for one name: it parts at commas.
std::string escaped(const std::string& name) {
  std::string out;
  for (const char c : name) out += c == ',' || c == '\\' ? std::string{'\\', c} : std::string{c};
  return out;
}

struct Recorder : doctest::IReporter {
  explicit Recorder(const doctest::ContextOptions&) {}
  void report_query(const doctest::QueryData&) override {}
  void test_run_start() override { mutation::write_asked("begin\t0\t1"); }
  void test_run_end(const doctest::TestRunStats&) override {}
  void test_case_start(const doctest::TestCaseData& data) override {
    ++cases_run;
    name_ = data.m_name;
    began_ = std::chrono::steady_clock::now();
  }
  void test_case_reenter(const doctest::TestCaseData&) override {}
  void test_case_end(const doctest::CurrentTestCaseStats& stats) override {
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began_;
    const bool passed = stats.failure_flags == doctest::TestCaseFailureReason::None;
    mutation::write_asked((name_ + "\t" + std::to_string(took.count()) + (passed ? "\t1" : "\t0")).c_str());
  }
  void test_case_exception(const doctest::TestCaseException&) override {}
  void subcase_start(const doctest::SubcaseSignature&) override {}
  void subcase_end() override {}
  void log_assert(const doctest::AssertData&) override {}
  void log_message(const doctest::MessageData&) override {}
  void test_case_skipped(const doctest::TestCaseData&) override {}

 private:
  std::string name_;
  std::chrono::steady_clock::time_point began_;
};
REGISTER_LISTENER("recorder", 1, Recorder);

}  // namespace

int main(int argc, char** argv) {
  doctest::Context context(argc, argv);
  int asked = 0;
  if (const char* path = std::getenv("MUTANT_CASES")) {
    std::ifstream names(path);
    for (std::string name; std::getline(names, name); ++asked)
      context.addFilter("test-case", escaped(name).c_str());
  }
  const int result = context.run();
  return result == 0 && cases_run < asked ? 99 : result;  // 99: a case was not found
}
