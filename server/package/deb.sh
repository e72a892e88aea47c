#!/bin/sh
# deb.sh BUILD: BUILD/reposed_VERSION_ARCHITECTURE.deb of what is built there. It needs libraries alone, as dpkg-shlibdeps finds them.
set -eu
build=$1
here=$(dirname "$0")
version=$(sed -n 's/^#define REPOSED_VERSION "\(.*\)".*/\1/p' api/text/version.h)
architecture=$(dpkg --print-architecture)
tree=$build/deb
rm -rf "$tree" && mkdir -p "$tree/tree/DEBIAN" "$tree/debian" "$tree/tree/etc"
trap 'rm -rf "$tree"' EXIT
sh "$here/install.sh" "$build" "$tree/tree" /usr
strip --strip-unneeded "$tree"/tree/usr/lib/reposed/*
gzip -9n "$tree"/tree/usr/share/man/man?/*
mkdir -p "$tree/tree/lib/systemd" && mv "$tree/tree/usr/lib/systemd/system" "$tree/tree/lib/systemd/" && rmdir "$tree/tree/usr/lib/systemd"
install -m 644 "$here/reposed.conf" "$tree/tree/etc/"
mv "$tree/tree/usr/share/doc/reposed/LICENSE" "$tree/tree/usr/share/doc/reposed/copyright"
printf 'Source: reposed\n\nPackage: reposed\nArchitecture: any\n' >"$tree/debian/control"
needs=$(cd "$tree" && dpkg-shlibdeps -O tree/usr/lib/reposed/reposed tree/usr/lib/reposed/repose* 2>/dev/null | sed -n 's/^shlibs:Depends=//p')
[ -n "$needs" ] || { echo "the libraries that the programs need can't be found" >&2; exit 1; }
cat >"$tree/tree/DEBIAN/control" <<CONTROL
Package: reposed
Version: $version
Architecture: $architecture
Maintainer: the authors of reposed <root@localhost>
Depends: $needs
Suggests: libcurl4
Section: science
Priority: optional
Installed-Size: $(du -sk --exclude=DEBIAN "$tree/tree" | cut -f 1)
Description: virtual rotary-drum tests of granular materials
 A service that runs rotating-drum and angle-of-repose tests by discrete elements. A test is posted as JSON; the answer is
 the angle of repose with its uncertainty, and the flow regime.
CONTROL
echo /etc/reposed.conf >"$tree/tree/DEBIAN/conffiles"
install -m 755 "$here"/debian/* "$tree/tree/DEBIAN/"
package=$build/reposed_${version}_$architecture.deb
dpkg-deb --root-owner-group --build "$tree/tree" "$package" >/dev/null
echo "$package"
