#!/bin/sh
# bench/latency.sh PROGRAM PROBLEM PLAN [DRAWS]: two processes with a network of 1 ms between them, as root: two network
# namespaces, each with a host name of its own, joined by bench/delayed_link.py, without delay and with 0.5 ms each way.
# Prints seconds without and with the delay.
set -eu
program=$1 problem=$2 plan=$3 draws=${4:-12000}
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
here=$(dirname "$0")
folder=$(mktemp -d)
link=
finish() {
  [ -z "$link" ] || kill "$link" 2>/dev/null || true
  ip netns del pw_first 2>/dev/null || true
  ip netns del pw_second 2>/dev/null || true
  rm -rf "$folder"
}
trap finish EXIT
ip netns add pw_first
ip netns add pw_second
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
  python3 "$here/delayed_link.py" pw_first pw_second "$(echo "$delay / 1000" | bc -l)" &
  link=$!
  sleep 1
  for end in first:10.99.7.1 second:10.99.7.2; do
    ip netns exec "pw_${end%%:*}" ip addr add "${end#*:}/24" dev pw
    ip netns exec "pw_${end%%:*}" ip link set pw up
    ip netns exec "pw_${end%%:*}" ip link set lo up
  done
  # A connection that is refused takes a way there and back.
  ip netns exec pw_first python3 -c 'import socket, time
begin = time.monotonic()
socket.socket().connect_ex(("10.99.7.2", 9))
print(f"there and back {1e3 * (time.monotonic() - begin):.2f} ms")'
  begin=$(date +%s.%N)
  run "$delay"
  end=$(date +%s.%N)
  kill "$link"
  wait "$link" 2>/dev/null || true
  echo "delay each way $delay ms: $(echo "$end - $begin" | bc) s"
done
cmp "$folder/0.json" "$folder/0.5.json" && echo "the same result"
