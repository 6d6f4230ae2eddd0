#!/usr/bin/env bash
# Pack an assignment for Gradescope:
#
#     examples/autograder/pack.sh ASSIGNMENT.py ROSTER.csv [FILE...] [-o autograder.zip]
#
# FILE are modules that the assignment imports. The zip file holds the assignment with its secret: it is the instructor's.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
loopbook=$(cd "$here/../.." && pwd)
python=${PYTHON:-python3}
output=autograder.zip
files=()
while [ $# -gt 0 ]; do
    case $1 in
        -o) output=${2:?-o needs the name of a file}; shift 2 ;;
        *) files+=("$1"); shift ;;
    esac
done
if [ ${#files[@]} -lt 2 ]; then
    echo "expected an assignment and a roster: pack.sh ASSIGNMENT.py ROSTER.csv [FILE...] [-o autograder.zip]" >&2
    exit 2
fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/course" "$folder/loopbook"
cp "${files[0]}" "$folder/course/"
basename "${files[0]}" > "$folder/course/assignment"
cp "${files[1]}" "$folder/course/roster.csv"
record="${files[0]%.py}.released.json"  # the numbers that were released
if [ -e "$record" ]; then
    cp "$record" "$folder/course/"
fi
if [ ${#files[@]} -gt 2 ]; then
    cp "${files[@]:2}" "$folder/course/"
fi
cp -r "$loopbook"/{environment.txt,pyproject.toml,README.md,LICENSE,lib} "$folder/loopbook/"
find "$folder/loopbook" -name __pycache__ -prune -exec rm -rf {} +
cp "$here"/{setup.sh,run_autograder,one_submission.py} "$folder/"

# Gradescope wants the two scripts at the root of the archive.
output=$(cd "$(dirname "$output")" && pwd)/$(basename "$output")
(cd "$folder" && "$python" -m zipfile -c "$output" setup.sh run_autograder one_submission.py course loopbook)
echo "$output"
