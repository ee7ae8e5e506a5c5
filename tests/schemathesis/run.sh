#!/usr/bin/env bash
# Requests by chance to every address of a server that takes sweeps: no answer is a failure of the server, and none has a status,
# a type or a form that its description does not have. Needs schemathesis (SLIPMAP_SCHEMATHESIS names it) and curl.
#
#     tests/schemathesis/run.sh [REQUESTS OF EACH ADDRESS]
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
slipmap=${SLIPMAP:-$here/../../target/release/slipmap}
folder=$(mktemp -d "${TMPDIR:-/tmp}/slipmap-schemathesis.XXXXXX")
server=
trap '[ -z "$server" ] || kill "$server"; rm -rf "$folder"' EXIT

cd "$folder"
mkdir maps
"$slipmap" run "$here/sweep.toml" -o maps/one.h5 --quiet >/dev/null
"$slipmap" submit "$here/sweep.toml" --to maps --again >/dev/null
"$slipmap" serve maps --submit --port 0 >links 2>/dev/null &
server=$!
until [ "$(wc -l <links)" = 2 ]; do sleep 0.1; done
link=$(head -n 1 links)
address=${link%%/\?*}
curl --silent --show-error --cookie-jar jar --location "$link" --output page
cookie=$(awk 'END { print $6 "=" $7 }' jar)

PYTHONPATH=$here SCHEMATHESIS_HOOKS=hooks "${SLIPMAP_SCHEMATHESIS:-schemathesis}" run "$address/api/v1/openapi.json" \
    --url "$address" --header "Cookie: $cookie" --header "Origin: $address" --header "Sec-Fetch-Site: same-origin" \
    --checks not_a_server_error,status_code_conformance,content_type_conformance,response_schema_conformance \
    --exclude-path /api/v1/events --max-examples "${1:-100}" --continue-on-failure
