# Stack of the exported functions with their callees, in bytes, from what gcc -fcallgraph-info=su writes:
#   awk -v prefix=NAME_ -f stack.awk NAME-size.ci
# Functions of the compiler's library, such as those for doubles without hardware, are not counted.

/^node: / {
	split($0, part, "\"")
	if (match($0, /[0-9]+ bytes/)) {
		own[part[2]] = substr($0, RSTART, RLENGTH) + 0
	}
	if (index(part[2], prefix) == 1) {
		exported[++count] = part[2]
	}
}

/^edge: / {
	split($0, part, "\"")
	callees[part[2]] = callees[part[2]] " " part[4]
}

# Returns the stack of a function with its deepest callee; no function calls itself.
function depth(name,   list, number, index_, deepest, found)
{
	if (name in known) {
		return known[name]
	}
	deepest = 0
	number = split(callees[name], list, " ")
	for (index_ = 1; index_ <= number; ++index_) {
		found = depth(list[index_])
		if (found > deepest) {
			deepest = found
		}
	}
	known[name] = own[name] + deepest
	return known[name]
}

END {
	for (place = 1; place <= count; ++place) {
		print exported[place] ": stack of " depth(exported[place]) " bytes"
	}
}
