#!/bin/sh
# Runs the benchmarks and puts their medians, with each one's share of the machine's bound, at the end of README.md.
# usage: bench/table.sh build/ci/bench/benchmarks [repetitions]
set -eu
program=$1
repetitions=${2:-5}
readme=$(dirname "$0")/README.md
results=$(mktemp)
text=$(mktemp)
trap 'rm -f "$results" "$text"' EXIT

# Where other programs hold a processor, a thread that spins at a barrier keeps it from the one that it waits for.
export GOMP_SPINCOUNT=${GOMP_SPINCOUNT:-10000}

load=$(cut -d' ' -f1 /proc/loadavg)
# The bounds are the best of many short repetitions: one of them is not interrupted.
"$program" --benchmark_format=json --benchmark_repetitions=40 --benchmark_min_time=0.005 \
  --benchmark_filter=machine >"$results" 2>/dev/null
"$program" --benchmark_format=json --benchmark_repetitions="$repetitions" --benchmark_report_aggregates_only=true \
  --benchmark_enable_random_interleaving=true --benchmark_min_time=0.05 \
  --benchmark_filter='(project|strain_and_force|update|xpic|sort).*/(ugimp|lcpdi)/|stress|scene/(disks|spheres|ellipses|fields/contact)' \
  >>"$results" 2>/dev/null

processor=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)
{
  sed '/<!-- figures -->/q' "$readme"
  echo
  echo "$(date -I), $processor, $(nproc) processors, load $load before; medians of $repetitions. Mp/s: million particles (scenes: particle-steps) per second."
  echo
  awk -F '": ' '
    function value(field) { return (field in read ? read[field] : 0) + 0 }
    /^    [{]/ { split("", read) }
    /^      "/ { key = $1; sub(/^ *"/, "", key); gsub(/[",]/, "", $2); read[key] = $2 }
    /^    [}]/ && read["run_type"] == "iteration" {
      threads = read["name"] ~ /threads:2/ ? 2 : 1
      if (read["name"] ~ /triad.*131072/ && value("B/s") > bandwidth[threads]) bandwidth[threads] = value("B/s")
      if (read["name"] ~ /multiply_add/ && value("flop/s") > peak[threads]) peak[threads] = value("flop/s")
    }
    /^    [}]/ && read["aggregate_name"] == "median" && read["name"] !~ /machine/ {
      name = read["name"]
      sub(/_median$/, "", name); sub(/\/real_time$/, "", name)
      threads = name ~ /threads:2/ ? 2 : 1
      sub(/\/?threads:[12]/, "", name)
      if (!(name in known)) { known[name] = 1; order[++names] = name }
      rate[name, threads] = value("items_per_second")
      bytes[name] = value("B/particle")
      flops[name] = value("flop/particle")
      nodes[name] = value("contact_nodes")
    }
    # Two threads that do not reach one and a half times the peak of one shared their processors with others.
    function alone(threads) { return threads == 1 || peak[2] > 1.5 * peak[1] }
    function share(name, threads,   seconds) {
      if (!bytes[name] || !alone(threads)) return ""
      seconds = bytes[name] / bandwidth[threads]
      if (flops[name] / peak[threads] > seconds) seconds = flops[name] / peak[threads]
      return sprintf("%.0f %%", 100 * rate[name, threads] * seconds)
    }
    function millions(name, threads) { return alone(threads) && (name, threads) in rate ? sprintf("%.1f", rate[name, threads] / 1e6) : "" }
    END {
      printf "Bounds: triad %.0f and %.0f GB/s, multiply-add %.0f and %.0f Gflop/s on 1 and 2 threads.\n\n",
        bandwidth[1] / 1e9, bandwidth[2] / 1e9, peak[1] / 1e9, peak[2] / 1e9
      if (!alone(2)) print "The processors were not free: the figures of 2 threads would say nothing and are left out.\n"
      print "| benchmark | B, flop a particle | Mp/s, 1 thread | of the bound | Mp/s, 2 threads | of the bound | contact nodes |"
      print "|---|---|---|---|---|---|---|"
      for (n = 1; n <= names; n++) {
        name = order[n]
        printf "| %s | %s | %s | %s | %s | %s | %s |\n", name,
          bytes[name] ? sprintf("%.0f, %.0f", bytes[name], flops[name]) : "",
          millions(name, 1), share(name, 1), millions(name, 2), share(name, 2), nodes[name] ? nodes[name] : "" | "sort"
      }
    }' "$results"
} >"$text"
cp "$text" "$readme"
