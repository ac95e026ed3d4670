!> Which of the words that the program knows is much like one that it does not know?
module similar_words
    implicit none
    private

    public :: difference, most_similar

contains

    !> The place of the word that is most like another one; 0 where none has half of its letters.
    pure integer function most_similar(word, words) result(place)
        character(len=*), intent(in) :: word, words(:)
        integer :: least, letters, i

        place = 0
        if (len(word) > 2 * len(words)) return   ! a long text, with which a table would be filled
        least = len(word) / 2 + 1
        do i = 1, size(words)
            letters = difference(word, trim(words(i)))
            if (letters >= least) cycle
            least = letters
            place = i
        end do
    end function most_similar

    !> How many letters differ: 1 for a word that is the beginning of the other one, the most there
    !> is where they have nothing in common.
    pure integer function difference(word, known) result(n)
        character(len=*), intent(in) :: word, known

        n = edits(word, known)
        if (index(known, word) == 1) then
            n = 1
        else if (n == len(word) .and. known(1:1) /= word(1:1)) then
            n = huge(n)
        end if
    end function difference

    !> How many letters must be changed, added, taken out or exchanged with the next one to turn
    !> one word into another?
    pure integer function edits(from, to) result(n)
        character(len=*), intent(in) :: from, to
        integer :: d(-1:len(from), -1:len(to)), cost, i, j

        d = len(from) + len(to)
        d(0:, 0) = [(i, i = 0, len(from))]
        d(0, 0:) = [(j, j = 0, len(to))]
        do j = 1, len(to)
            do i = 1, len(from)
                cost = merge(0, 1, from(i:i) == to(j:j))
                d(i, j) = min(d(i - 1, j) + 1, d(i, j - 1) + 1, d(i - 1, j - 1) + cost)
                if (min(i, j) == 1) cycle
                if (from(i:i) == to(j - 1:j - 1) .and. from(i - 1:i - 1) == to(j:j)) d(i, j) = &
                    min(d(i, j), d(i - 2, j - 2) + 1)
            end do
        end do
        n = d(len(from), len(to))
    end function edits

end module similar_words
