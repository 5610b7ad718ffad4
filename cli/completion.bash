# Completion of ropsim for bash: source this file, or put it into /usr/share/bash-completion/completions/ropsim.
# Names of designs, GPUs, workloads and generators come from the program itself.

_ropsim_names() {
    "${COMP_WORDS[0]}" describe --names "$1" 2>/dev/null
}

_ropsim_words() {
    mapfile -t COMPREPLY < <(compgen -W "$1" -- "${COMP_WORDS[COMP_CWORD]}")
}

# The part after the last comma, with what is before it kept.
_ropsim_list() {
    local word=${COMP_WORDS[COMP_CWORD]} before=""
    [[ $word != *,* ]] || before=${word%,*},
    mapfile -t COMPREPLY < <(compgen -P "$before" -W "$1" -- "${word##*,}")
    compopt -o nospace
}

_ropsim_files() {
    local word=${COMP_WORDS[COMP_CWORD]} entry
    compopt -o filenames 2>/dev/null
    while read -r entry; do
        [[ -d $entry || $entry == *.$1 || $entry == *.${2:-$1} ]] && COMPREPLY+=("$entry")
    done < <(compgen -f -- "$word")
}

_ropsim() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]}
    local frame="--gpu --workload --k --entry --program --size --samples --camera --light --seed --threads --set --out --json --no-images --help"
    COMPREPLY=()
    if ((COMP_CWORD == 1)); then
        _ropsim_words "compare run truth accuracy geometry validate calibrate study sensitivity stability capture record import replay trace describe --help --version"
        return
    fi
    case $before in
        --gpu) _ropsim_words "$(_ropsim_names gpus)"; return ;;
        --design) _ropsim_words "$(_ropsim_names designs)"; return ;;
        --designs) _ropsim_list "$(_ropsim_names designs) all"; return ;;
        --workload) _ropsim_words "$(_ropsim_names workloads)"; return ;;
        --entry) _ropsim_words "rgbz z zo"; return ;;
        --program) _ropsim_words "nearest-k order-and-blend mlab"; _ropsim_files kb glsl; return ;;
        --set) _ropsim_words "$(_ropsim_names params | sed 's/$/=/')"; compopt -o nospace; return ;;
        --samples) _ropsim_words "1 4 8"; return ;;
        --size) _ropsim_words "256x256 512x512 1024x1024 1920x1080"; return ;;
        --camera) _ropsim_words "auto 0"; return ;;
        --gpus) _ropsim_list "$(_ropsim_names gpus)"; return ;;
        --prepare) _ropsim_words "$(_ropsim_names preparations)"; return ;;
        --submission) _ropsim_words "buffers client_arrays immediate display_list"; return ;;
        --reads) _ropsim_words "all position"; return ;;
        --fidelity) _ropsim_words "estimate detailed"; return ;;
        --export) _ropsim_files glb; return ;;
        -o | --output) _ropsim_files rtrace; return ;;
        --name | --licence) return ;;
        --out | --write) mapfile -t COMPREPLY < <(compgen -d -- "$word"); compopt -o filenames; return ;;
        --parameters) _ropsim_list "$(_ropsim_names params)"; return ;;
        --filter) _ropsim_list "$(_ropsim_names stability)"; return ;;
        --factor | --equal-area) return ;;
        --k | --seed | --threads | --layers | --light | --rays | --sweep | --against | --averaged) return ;;
    esac
    local measure="--gpus --fidelity --threads --json --help"
    case $command in
        compare) [[ $word == -* ]] && _ropsim_words "--designs --equal-area $frame" || _ropsim_files glb gltf ;;
        run) [[ $word == -* ]] && _ropsim_words "--design $frame" || _ropsim_files glb gltf ;;
        sensitivity)
            [[ $word == -* ]] && _ropsim_words "--designs --parameters --factor ${frame/ --no-images/}" ||
                _ropsim_files glb gltf ;;
        truth)
            [[ $word == -* ]] && _ropsim_words "--workload --k --entry --program --size --camera --set --layers --light --rays --seed --threads --check --out --json --no-images --no-cache --help" ||
                _ropsim_files glb gltf ;;
        accuracy)
            [[ $word == -* ]] && _ropsim_words "--design --sweep --rays --against --averaged --no-cache $frame" || _ropsim_files glb gltf ;;
        geometry)
            [[ $word == -* ]] && _ropsim_words "--gpu --prepare --submission --reads --fidelity --seed --set --export --out --json --help" ||
                _ropsim_files glb gltf ;;
        capture)
            [[ $word == -* ]] && _ropsim_words "--workload --k --entry --program --size --samples --camera --light --set --output --name --licence --json --help" ||
                _ropsim_files glb gltf ;;
        record)
            [[ $word == -* ]] && _ropsim_words "--frames --output --isotropic --name --licence --json --help" ||
                mapfile -t COMPREPLY < <(compgen -c -- "$word") ;;
        import)
            [[ $word == -* ]] && _ropsim_words "--frames --output --isotropic --name --licence --json --help" ||
                _ropsim_files trace ;;
        replay)
            [[ $word == -* ]] && _ropsim_words "--gpu --designs --equal-area --seed --threads --set --out --json --no-images --help" ||
                _ropsim_files rtrace ;;
        trace)
            if ((COMP_CWORD == 2)); then
                _ropsim_words "info dump validate diff"
            else
                [[ $word == -* ]] && _ropsim_words "--json --help" || _ropsim_files rtrace
            fi ;;
        validate) [[ $word == -* ]] && _ropsim_words "--leave-one-out --lights --size --out $measure" || _ropsim_words "geometry peeling deferred" ;;
        calibrate) [[ $word == -* ]] && _ropsim_words "--write --folds --seed --out $measure" || _ropsim_words "geometry peeling" ;;
        study) [[ $word == -* ]] && _ropsim_words "--out $measure" || _ropsim_words "$(_ropsim_names studies)" ;;
        stability) _ropsim_words "--filter --out --json --no-images --help" ;;
        describe)
            if [[ $word == -* ]]; then
                _ropsim_words "--names --json --help"
            else
                _ropsim_words "$(_ropsim_names; _ropsim_names gpus; _ropsim_names designs; _ropsim_names workloads)"
            fi ;;
    esac
}

complete -F _ropsim ropsim
