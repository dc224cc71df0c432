#!/bin/sh
# Checks this bundle again: the digests of its files, then its evidence with z3, cvc5 and, where coqc is
# installed, the kernel of Coq, in a fresh environment whose packages are pinned by their digests. Assurance
# cases and requirements inside are checked against the evidence.
#
#   sh check.sh [PYTHON]        PYTHON: @python@ on @platform@ (default: python@python@)
#
# Exit code 0 where the evidence comes out as it did when the bundle was made, and all cases and requirements
# inside hold.
set -u
cd "$(dirname "$0")" || exit 2
python=${1:-python@python@}
fail=0

sha256sum --check --quiet SHA256SUMS || { echo "FAILED: files are not those of the bundle"; exit 10; }
echo "digests: all files are those of the bundle"

version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])') || exit 2
[ "$version" = "@python@" ] || { echo "Python @python@ is needed, and $python is $version"; exit 2; }
place=$(mktemp -d) || exit 2
trap 'rm -rf "$place"' EXIT
"$python" -m venv "$place/environment" || exit 2
"$place/environment/bin/python" -m pip install --quiet --no-compile --disable-pip-version-check --require-hashes --no-deps @wheels@ -r requirements.txt || exit 2
HOME=$place ROADPROOF_QUIET=1 PATH=$place/environment/bin:$PATH
export HOME ROADPROOF_QUIET PATH
unset PYTHONPATH

check() {
	roadproof check @specs@ "$@" @evidence@ > "$place/told" 2>&1
	code=$?
	grep '^[0-9]* of [0-9]* accepted by ' "$place/told" || tail -n 1 "$place/told"
	[ $code -eq @code@ ] && return
	grep -v '^PROVED\|^WITNESSED' "$place/told" | head -n 20
	return 1
}

for solver in z3 cvc5; do
	check --solver $solver || { echo "FAILED: with $solver the exit code is $code, not @code@"; fail=10; }
done
if command -v coqc > /dev/null; then
	# Coq leaves open what it has no proof for (exit code 20); it must reject nothing.
	check --kernel coq || [ $code -eq 20 ] || { echo "FAILED: Coq rejects evidence (exit code $code)"; fail=10; }
else
	echo "coq: coqc is not installed, so its kernel is not asked"
fi
# Check an assurance case or requirements: ``argue COMMAND FILE``.
argue() {
	roadproof "$1" "$2" @specs@ > "$place/told" 2>&1
	code=$?
	tail -n 1 "$place/told"
	[ $code -eq 0 ] && return
	head -n 20 "$place/told"
	echo "FAILED: the exit code of $1 $2 is $code"
	fail=10
}

@arguments@
[ $fail -eq 0 ] && echo "OK: everything comes out as when the bundle was made"
exit $fail
