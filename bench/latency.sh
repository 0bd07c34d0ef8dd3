#!/bin/sh
# bench/latency.sh PROGRAM PROBLEM PLAN [DRAWS]: two processes with a network of 1 ms between them, as root: two network
# namespaces, each with a host name of its own, joined by a veth pair, without delay and with 0.5 ms each way (tc netem).
# Prints seconds without and with the delay.
set -eu
program=$1 problem=$2 plan=$3 draws=${4:-12000}
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
folder=$(mktemp -d)
finish() {
  ip netns del pw_first 2>/dev/null || true
  ip netns del pw_second 2>/dev/null || true
  rm -rf "$folder"
}
trap finish EXIT
ip netns add pw_first
ip netns add pw_second
ip link add pw0 netns pw_first type veth peer name pw1 netns pw_second
for side in "first pw0 10.99.7.1" "second pw1 10.99.7.2"; do
  set -- $side
  ip netns exec "pw_$1" ip addr add "$3/24" dev "$2"
  ip netns exec "pw_$1" ip link set "$2" up
  ip netns exec "pw_$1" ip link set lo up
done
# What mpirun starts the other machine's part by: HOST COMMAND...
cat > "$folder/agent" <<'AGENT'
#!/bin/sh
shift
exec ip netns exec pw_second unshare --uts sh -c "hostname pw-second; $*"
AGENT
chmod +x "$folder/agent"
run() {
  ip netns exec pw_first unshare --uts sh -c "hostname pw-first; exec mpirun --host 10.99.7.1:1,10.99.7.2:1 -n 2 \
    --mca plm_rsh_agent $folder/agent --mca btl self,tcp --mca btl_tcp_if_include 10.99.7.0/24 \
    --mca oob_tcp_if_include 10.99.7.0/24 --mca pml ob1 \
    $program simulate $problem $plan --draws $draws --threads 1 --json --verbose" > "$folder/$1.json" 2> "$folder/$1.err"
  tail -n 1 "$folder/$1.err"
}
for delay in 0 0.5; do
  if [ "$delay" != 0 ]; then
    ip netns exec pw_first tc qdisc add dev pw0 root netem delay "${delay}ms" 2>/dev/null || {
      echo "skipped: this kernel has no netem to delay packets with"
      exit 0
    }
    ip netns exec pw_second tc qdisc add dev pw1 root netem delay "${delay}ms"
  fi
  ip netns exec pw_first ping -c 3 -q 10.99.7.2 2>/dev/null | tail -n 1 || true
  begin=$(date +%s.%N)
  run "$delay"
  end=$(date +%s.%N)
  echo "delay each way $delay ms: $(echo "$end - $begin" | bc) s"
done
cmp "$folder/0.json" "$folder/0.5.json" && echo "the same result"
