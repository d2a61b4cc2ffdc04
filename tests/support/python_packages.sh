# Sourced by scripts that run tests in Python.
python=/usr/bin/python3

# Ends the script with SKIPPED where Debian's Python has no NumPy or Pillow.
skip_without_pictures() { # subject of the tests
  local package
  for package in numpy PIL; do
    if ! "$python" -c "import $package" 2>/dev/null; then
      echo "SKIPPED: $1: $package is missing (packages python3-numpy and python3-pil)"
      exit 0
    fi
  done
}
