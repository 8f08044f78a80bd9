# aphotic on disks of so many KiB: faults_test.cpp puts the command's path into APHOTIC, wavelengths into
# WORDS. Each line of the result: command, KiB left, status, message in one line; then what is amiss.
mkdir disk
fill() { dd if=/dev/zero of=disk/fill bs=1k 2>/dev/null; truncate -s -$1k disk/fill; }
same() { cmp -s $1 $2 || echo "amiss: $1 is not $2"; }
try() {
  name=$1; kib=$2; expected=$3; shift 3
  fill $kib; "$APHOTIC" "$@" >/dev/null 2>err; status=$?
  echo "$name $kib $status $(tr '\n' ' ' <err)"
  find disk -name '.*.part*' -o -name '*.pov-state' | sed 's/^/amiss: /'
  for image in disk/out/image.exr disk/out/spectral.exr; do
    [ ! -e $image ] || same $image $expected/${image##*/}
  done
  rm disk/fill
  "$APHOTIC" "$@" >/dev/null || echo "amiss: $name with space"
  if [ $expected = generated ]; then
    diff -r $expected disk/out | sed 's/^/amiss: /'
  else
    same disk/out/image.exr $expected/image.exr
    same disk/out/spectral.exr $expected/spectral.exr
  fi
}
for kib in 0 8 36 44 52; do
  mount -t tmpfs -o size=512k none disk
  try render $kib out render rig.toml --ignore-needs -o disk/out $WORDS
  umount disk
done
for kib in 0 8 28; do
  mount -t tmpfs -o size=512k none disk
  try generate $kib generated generate rig.toml --ignore-needs -o disk/out $WORDS
  umount disk
done
for kib in 0 8 16; do
  mount -t tmpfs -o size=512k none disk
  try trace $kib traced trace rig.toml --ignore-needs -o disk/out
  umount disk
done
# Over the results of an earlier run, which stay.
for kib in 0 8; do
  mount -t tmpfs -o size=512k none disk
  cp -r out disk/out
  try again $kib out render rig.toml --ignore-needs -o disk/out $WORDS
  try integrate $kib out integrate --ignore-needs disk/out
  umount disk
done
