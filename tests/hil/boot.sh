#!/usr/bin/env bash
# Boots the virtual machine, runs one job in it and ends with the job's status.
#   boot.sh WORK JOB [NAME=VALUE...]       after prepare.sh WORK
# JOB is a script of tests/hil/guest; NAME=VALUE goes into its environment. HIL_INIT in the environment names another
# process 1 than guest/init, HIL_QEMU further options of QEMU, HIL_TIMEOUT_S the seconds after which a machine hangs
# (default 2200), HIL_ACCEL=kvm uses KVM in place of emulation (nested KVM is often there
# and does not boot, which is why it has to be asked for).
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$(realpath "${1:?boot.sh WORK JOB}")
job=${2:?boot.sh WORK JOB}
shift 2
release=$(cat "$work/release")
share=$work/$job
rm -rf "$share"
mkdir -p "$share"
cp "$here/guest/$job" "$share/job"
cp "$here/guest/${HIL_INIT:-init}" "$share/init"
cp "$here/guest/finish" "$share/finish"
printf 'export %q\n' "KERNEL_ROOT=$work/kernel" "KERNEL_RELEASE=$release" "$@" >"$share/environment"

# Root in the machine is to read what root can read here.
as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo -n)
boot() { # QEMU options of the accelerator
  "${as_root[@]}" timeout -k 5 "${HIL_TIMEOUT_S:-2200}" qemu-system-x86_64 -M q35 "$@" -smp 2 -m 2560 \
    -nodefaults -no-user-config -nographic -no-reboot -serial "file:$share/console" \
    -kernel "$work/vmlinux" -initrd "$work/initrd.img" \
    -append "console=ttyS0 quiet panic=-1 oops=panic mitigations=off nokaslr random.trust_cpu=on audit=0 apparmor=0 selinux=0" \
    -fsdev local,id=root,path=/,security_model=none,readonly=on,multidevs=remap \
    -device virtio-9p-pci,fsdev=root,mount_tag=hil_root \
    -fsdev "local,id=share,path=$share,security_model=none" -device virtio-9p-pci,fsdev=share,mount_tag=hil_share \
    -device isa-debug-exit,iobase=0xf4,iosize=0x04 ${HIL_QEMU:-} </dev/null 2>"$share/qemu.log"
}

started=$SECONDS
if [ "${HIL_ACCEL:-tcg}" = kvm ]; then
  boot -accel kvm -cpu host
else
  # Nehalem has no AVX, which llvmpipe is slower with under emulation.
  boot -accel tcg,thread=multi,tb-size=512 -cpu Nehalem
fi
qemu=$?
cat "$share/log" 2>/dev/null
status=$(cat "$share/status" 2>/dev/null || echo none)
echo "hil: $job ended with $status after $((SECONDS - started)) s (${HIL_ACCEL:-tcg}, Linux $release)"
# isa-debug-exit gives twice the written status, plus 1.
if [ "$status" = none ] || [ $(((qemu - 1) / 2)) -ne $((status & 127)) ]; then
  echo "hil: the machine did not come to an orderly end (QEMU's status is $qemu); its console closed with:" >&2
  tail -n 25 "$share/console" >&2
  tail -n 5 "$share/qemu.log" >&2
  exit 125
fi
exit "$status"
