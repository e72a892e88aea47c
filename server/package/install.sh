#!/bin/sh
# install.sh BUILD DESTDIR PREFIX: puts what was built below DESTDIR/PREFIX. The programs lie together in lib/reposed, where each
# finds the others beside itself, and the page and the documents at ../../share/reposed (server/daemon/base/config.c), so the
# whole may be moved.
set -eu
build=$1 root=$2$3
case $3 in
/*) ;;
*) echo "PREFIX is \"$3\"; must begin with /" >&2; exit 2 ;;
esac
sources=$(dirname "$0")

put() { # MODE FOLDER FILE...
  mode=$1 folder=$root/$2
  shift 2
  install -d -m 755 "$folder"
  install -p -m "$mode" "$@" "$folder"
}

put 755 lib/reposed "$build/reposed" "$build"/repose "$build"/repose-single-avx512 "$build"/repose-single-avx2 \
  "$build"/repose-double-avx512 "$build"/repose-double-avx2 "$build"/repose-double-plain "$build"/repose-plan
install -d -m 755 "$root/bin"
for program in reposed repose; do ln -sfn "../lib/reposed/$program" "$root/bin/$program"; done
put 644 share/reposed/web web/*.html web/*.js web/*.css web/*.svg web/*.png
put 644 share/reposed/web/vendor web/vendor/*
put 644 share/reposed/api api/openapi.yaml
put 644 share/reposed/api/examples api/examples/*.json
put 644 share/reposed/api/examples/instruments api/examples/instruments/*.json
put 644 share/reposed/api/studies api/studies/*.json
put 644 share/doc/reposed "$sources/reposed.conf" server/slurm.conf.example README.md LICENSE core/NUMERICS.md server/DESIGN.md \
  api/CALIBRATION.md api/CONFORMANCE.md api/FRAMES.md
put 644 share/man/man1 "$sources/repose.1"
put 644 share/man/man8 "$sources/reposed.8"
put 644 share/bash-completion/completions "$sources/reposed"
ln -sfn reposed "$root/share/bash-completion/completions/repose"
put 644 lib/sysusers.d "$sources/sysusers.d/reposed.conf"
install -d -m 755 "$root/lib/systemd/system"
sed "s|@PREFIX@|$3|" server/reposed.service >"$root/lib/systemd/system/reposed.service"
chmod 644 "$root/lib/systemd/system/reposed.service"
